// The command that writes the scene as a web page.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/memory_budget.hpp"
#include "viewer/scene/stage.hpp"

namespace tureen::viewer {

struct PageRequest {
  DrawingChoice choice = {};  // the page keeps its profile and quality
  std::optional<std::uint64_t> max_splats = {};
  std::uint64_t max_memory = default_max_memory;
  glm::dvec3 up{0.0};               // the up axis that the window shows
  std::filesystem::path view = {};  // a camera file with the page's first view; empty: none
};

/// The arguments of `tureen` that write the scene's files as one page. Options carry the
/// differences between window and files: places (place_arguments()), up axis, profile, quality,
/// view.
std::vector<std::string> page_arguments(const SceneSource& scene, const PageRequest& request,
                                        const std::filesystem::path& page);

}  // namespace tureen::viewer
