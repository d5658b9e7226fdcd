// Lossy compression of triangles with an adjustable error: the geometry of a compressed file
// (docs/format.md, version 3).
//
// Positions lie on a grid from the corner of the soup's box. A face's first corner is predicted
// from the previous face, the other two from the first. A repeated corner is coded by its distance
// back. Faces that are adjacent in space therefore take the fewest bytes.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "base/memory_budget.hpp"

namespace tureen {

/// Vertices and the triangles that use them.
struct CompressedGeometry {
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> triangles;
};

/// Number of distinct vertices in the triangles; a compressed file stores only these.
std::size_t used_vertices(std::span<const glm::uvec3> triangles);

/// Largest number of grid bits along the longest side of the box.
inline constexpr int max_compressed_bits = 23;

/// Encodes the triangles with positions rounded to a grid of 2^bits steps along the longest side of
/// their box, 1..max_compressed_bits. The error is at most half a step in each coordinate. Vertices
/// are decoded in the order of their first use; unused ones are dropped. Throws UsageError if a
/// used position is not finite.
std::vector<std::byte> encode_compressed_geometry(const CompressedGeometry& geometry, int bits);

/// Throws InputError, which names `file`, if the bytes are truncated, have other numbers of faces
/// or vertices, or exceed the budget. Allocates at most 4,096 bytes per input byte.
CompressedGeometry decode_compressed_geometry(std::span<const std::byte> bytes,
                                              std::size_t vertices, std::size_t faces,
                                              const std::string& file,
                                              MemoryBudget budget = MemoryBudget());

}  // namespace tureen
