// Wavefront OBJ as far as MobileNeRF needs it: v, vt and f. Everything else (normals, groups,
// materials, smoothing) is read past, and so is what follows x y z and u v on their lines.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "base/input.hpp"

namespace tureen {

/// Triangles whose corners have a position and a place in a texture. A vertex is made for each
/// distinct pair of the two that a face names, in the order of first use.
struct ObjMesh {
  std::vector<glm::vec3> positions;  // one a vertex
  std::vector<glm::vec2> uv;         // one a vertex; v grows upwards
  std::vector<glm::uvec3> triangles;
};

/// Polygons become fans; negative indices count back from the last v or vt so far. Throws an
/// InputError with the line for a number that is none, an index out of range, a corner without vt
/// and a face of fewer than three corners.
ObjMesh read_obj(Input& input);

}  // namespace tureen
