// The order of splats in memory: neighbours in space are neighbours in memory, so that the splats
// of a tile are in few cache lines.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "base/radix_sort.hpp"
#include "scene/morton.hpp"
#include "scene/region.hpp"
#include "splatting/parameter_rows.hpp"

namespace tureen::trainer {

/// The indices of points along the Morton curve with 10 bits an axis over the region; points
/// outside have the place of the nearest one inside, and those that are not finite are the last.
inline std::vector<std::uint32_t> morton_order(std::span<const glm::vec3> points,
                                               const Region& region) {
  std::vector<KeyedIndex> keys, scratch;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    std::uint32_t key = 0;
    bool finite = true;
    for (int axis = 0; axis < 3; ++axis) {
      const double place =
          512 * (1 + (double(points[i][axis]) - region.center[axis]) / region.half_side);
      finite = finite && std::isfinite(place);
      const auto cell = finite ? std::uint32_t(std::clamp(place, 0.0, 1023.0)) : 0u;
      key |= std::uint32_t(spread_bits(cell)) << axis;
    }
    keys.push_back({finite ? key : ~0u, i});
  }
  radix_sort(keys, scratch);
  std::vector<std::uint32_t> order;
  for (const KeyedIndex& each : keys) order.push_back(each.index);
  return order;
}

/// Rows [0, row_count) of the splats order[0], order[1], ..
inline splatting::ParameterRows reordered(const splatting::ParameterRows& rows,
                                          std::size_t row_count,
                                          std::span<const std::uint32_t> order) {
  splatting::ParameterRows result(row_count, order.size());
  for (std::size_t r = 0; r < row_count; ++r)
    for (std::size_t i = 0; i < order.size(); ++i) result.row(r)[i] = rows.row(r)[order[i]];
  return result;
}

/// The same rows for more splats, with zeros.
inline splatting::ParameterRows enlarged(const splatting::ParameterRows& rows,
                                         std::size_t row_count, std::size_t count) {
  splatting::ParameterRows result(row_count, count);
  for (std::size_t r = 0; r < row_count; ++r) std::copy_n(rows.row(r), rows.count(), result.row(r));
  return result;
}

}  // namespace tureen::trainer
