// Triangles in few bytes, with a loss that the caller sets: the geometry of a slim file
// (docs/format.md, version 3).
//
// Positions lie on a grid from the corner of the soup's box. A face's first corner is told from the
// face before it, the other two from the first; a corner that was there already is named by how
// long ago. So faces that follow each other in space take the fewest bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "base/memory_budget.hpp"

namespace tureen {

/// Vertices and the triangles that use them.
struct SlimGeometry {
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> triangles;
};

/// How many different vertices the triangles use: a slim file holds no others.
std::size_t used_vertices(std::span<const glm::uvec3> triangles);

/// Bits of the longest side of the box that a grid may have.
inline constexpr int max_slim_bits = 23;

/// The triangles, with positions rounded to a grid of 2^bits steps along the longest side of their
/// box, 1..max_slim_bits: off by half a step at most in each coordinate. Vertices come back in the
/// order in which triangles first use them, those that none uses not at all. Throws UsageError
/// where a position that is used is not finite.
std::vector<std::byte> encode_slim_geometry(const SlimGeometry& geometry, int bits);

/// Throws InputError, which names `file`, for bytes that were cut short or hold other than so many
/// faces and vertices, or take more memory than the budget has left. At most 4,096 bytes are
/// allocated for each one that is there.
SlimGeometry decode_slim_geometry(std::span<const std::byte> bytes, std::size_t vertices,
                                  std::size_t faces, const std::string& file,
                                  MemoryBudget budget = MemoryBudget());

}  // namespace tureen
