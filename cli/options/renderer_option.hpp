// --renderer: what draws images. OpenGL does by default; the renderers here need none.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "cli/options/arguments.hpp"
#include "runtime/renderer.hpp"
#include "scene/image_source.hpp"
#include "scene/scene.hpp"

namespace tureen::cli {

struct ProcessorImages {
  Quality quality;
  std::optional<glm::vec3> background;   // nullopt: transparent
  std::function<void(double)> progress;  // called with the fraction done of an image
};

/// Draws whole images on the CPU.
struct ProcessorRenderer {
  const char* name;  // as --renderer takes it
  /// The scene must outlive the result. Throws UsageError for what it does not support.
  std::unique_ptr<ImageSource> (*make)(const Scene& scene, const ProcessorImages& images);
};

/// Adds --renderer, after all other options. Null: OpenGL. The returned function throws UsageError
/// if a processor renderer is chosen and an option is given that only OpenGL supports; call it
/// after parsing.
std::function<void()> add_renderer_option(Command& command, const ProcessorRenderer*& renderer);

}  // namespace tureen::cli
