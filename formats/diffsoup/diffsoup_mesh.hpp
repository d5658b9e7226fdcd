// mesh.ply of a DiffSoup export: positions and triangles, binary. Face t owns the t-th stretch of
// texels, so every face must come through, in order: this is no general PLY reader.
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "base/input.hpp"
#include "base/output.hpp"

namespace tureen {

struct DiffSoupMesh {
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> triangles;  // every index is that of a position
};

/// Reads a binary little-endian PLY of the elements vertex and face. Comments, line ends of either
/// kind, further properties of fixed size and any integer type are read past; x, y, z are floats or
/// doubles. Throws InputError, also for a face that is no triangle.
DiffSoupMesh read_diffsoup_mesh(Input& input);

/// Writes the exact layout of the published exporter: float x y z, then "uchar int" lists.
void write_diffsoup_mesh(Output& output, std::span<const glm::vec3> positions,
                         std::span<const glm::uvec3> triangles);

}  // namespace tureen
