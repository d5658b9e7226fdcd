// PLY files: polygons (mesh/mesh_ply.hpp), splats (splat/splat_ply.hpp) and compressed splats
// (splat/compressed_ply.hpp). The names of the header's elements and properties tell them apart.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/input.hpp"
#include "formats/read_options.hpp"
#include "scene/scene.hpp"

namespace tureen {

/// Throws InputError with the byte (binary) or the line (header and ascii).
Scene read_ply(Input& input, const ReadOptions& options = {});
Scene read_ply(const std::filesystem::path& path, const ReadOptions& options = {});

/// The up axis that readers assume of the PLY that write_ply() makes of this scene.
glm::vec3 assumed_up_of_ply(const Scene& scene);

/// Splats if fits_splat_ply() (formats/splat/splat_ply.hpp), otherwise polygons. Returns the
/// losses. Throws OutputError.
std::vector<std::string> write_ply(const Scene& scene, const std::filesystem::path& path);

}  // namespace tureen
