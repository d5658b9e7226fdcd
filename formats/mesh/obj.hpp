// Wavefront OBJ. Reading is limited to the needs of MobileNeRF: v, vt and f. Other lines (normals,
// groups, materials, smoothing) are skipped, as are values after x y z and u v.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "base/input.hpp"
#include "scene/scene.hpp"

namespace tureen {

/// Triangles whose corners have a position and a texture coordinate. Each distinct pair in a face
/// becomes a vertex, in the order of first use.
struct ObjMesh {
  std::vector<glm::vec3> positions;  // one a vertex
  std::vector<glm::vec2> uv;         // one a vertex; v grows upwards
  std::vector<glm::uvec3> triangles;
};

/// Polygons become fans; negative indices count back from the last v or vt so far. Throws
/// InputError with the line for an invalid number, an index out of range, a corner without vt and a
/// face with fewer than three corners.
ObjMesh read_obj(Input& input);

/// Triangles with a colour for each vertex, after its coordinates (as MeshLab, Blender and others
/// read them); faces with a colour of their own get their own vertices. Positions and colours read
/// back bit for bit. Returns the losses. Throws UsageError for splats, OutputError.
std::vector<std::string> write_obj(const Scene& scene, const std::filesystem::path& path);

}  // namespace tureen
