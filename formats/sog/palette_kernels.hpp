// The loops of palette.cpp over points, in Highway's vectors.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace tureen {

/// Rows that a kernel treats together, so that each point is loaded once for all of them.
inline constexpr std::size_t rows_at_once = 4;
using PointRows = std::array<const float*, rows_at_once>;

/// Points in blocks: value d of all points of a block is contiguous.
class PointBlocks {
 public:
  /// Points of a block: two of the widest vectors, so that sums do not wait for each other.
  static constexpr std::size_t lanes = 32;

  /// `rows`: points of `dimensions` values each.
  PointBlocks(std::span<const float> rows, std::size_t dimensions);

  struct Nearest {
    float score = std::numeric_limits<float>::max();  // (squared distance - squared row) / 2
    std::uint32_t point = 0;
  };

  /// Improves `best` of each of the rows by all points, numbered from `first` on. Sums are rounded
  /// once per term or twice, by the processor.
  void improve(const PointRows& rows, std::uint32_t first,
               std::array<Nearest, rows_at_once>& best) const;

  /// The scores of all points for each row: padded_count() values, with the largest float for those
  /// without a point.
  void scores(const PointRows& rows, const std::array<float*, rows_at_once>& out) const;
  std::size_t padded_count() const { return offsets.size(); }

  std::size_t dimensions;
  std::vector<float> values, offsets;  // offsets: half the squared length
};

}  // namespace tureen
