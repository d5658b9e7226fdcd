// mesh.ply of a DiffSoup export: positions and triangles, binary. Face t owns the t-th block of
// texels, so the reader keeps every face in order. It is not a general PLY reader.
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "base/input.hpp"
#include "base/output.hpp"

namespace tureen {

struct DiffSoupMesh {
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> triangles;  // valid indices into positions
};

/// Reads a binary little-endian PLY with the elements vertex and face. Comments, both line endings,
/// further properties of fixed size and any integer type are accepted; x, y, z are floats or
/// doubles. Throws InputError, also for faces that are not triangles.
DiffSoupMesh read_diffsoup_mesh(Input& input);

/// Writes the exact layout of the published exporter: float x y z, then "uchar int" lists.
void write_diffsoup_mesh(Output& output, std::span<const glm::vec3> positions,
                         std::span<const glm::uvec3> triangles);

}  // namespace tureen
