// The state of splats in training beside their parameters, for splats of any kernel.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "splatting/parameter_rows.hpp"
#include "trainer/splats/splat_order.hpp"

namespace tureen::trainer {

/// The numbers [begin, end) of a splat's pairs with tiles.
struct PairSpan {
  std::uint32_t begin, end;
};

/// Rows of SplatMemory::statistics.
namespace splat_statistic {
enum : std::size_t {
  steps,    // of Adam
  motion,   // sum over steps of |dL / d image of the splat|, per pixel
  evident,  // > 0: some pixel had at least evident_weight
  count
};
}

/// The state of Adam and of the densifier, for each splat; zeros at first.
struct SplatMemory {
  static constexpr std::size_t block = splatting::row_alignment;
  /// A value of `block` consecutive splats.
  struct alignas(64) Line {
    float values[block];
  };
  std::size_t rows = 0;  // of the parameters
  /// For each block of splats and each row: the first moments, then the second ones.
  std::vector<Line> moments;
  splatting::ParameterRows statistics;  // rows of splat_statistic

  SplatMemory() = default;
  SplatMemory(std::size_t rows_of_parameters, std::size_t count)
      : rows(rows_of_parameters),
        moments(2 * rows * ((count + block - 1) / block)),
        statistics(splat_statistic::count, count) {}

  /// The lines of the block of splat `i`: two a row.
  Line* lines_of(std::size_t i) { return moments.data() + 2 * rows * (i / block); }

  /// Sets all values of splat `i` to 0.
  void reset(std::size_t i) {
    for (std::size_t line = 0; line < 2 * rows; ++line) lines_of(i)[line].values[i % block] = 0;
    for (std::size_t which = 0; which < splat_statistic::count; ++which)
      statistics.row(which)[i] = 0;
  }

  /// Room for more splats, with zeros.
  void enlarge(std::size_t count) {
    SplatMemory more(rows, count);
    std::copy(moments.begin(), moments.end(), more.moments.begin());
    more.statistics = enlarged(statistics, splat_statistic::count, count);
    *this = std::move(more);
  }

  /// Splat i becomes the one at order[i].
  void reorder(std::span<const std::uint32_t> order) {
    SplatMemory sorted(rows, order.size());
    for (std::size_t i = 0; i < order.size(); ++i)
      for (std::size_t line = 0; line < 2 * rows; ++line)
        sorted.lines_of(i)[line].values[i % block] =
            lines_of(order[i])[line].values[order[i] % block];
    sorted.statistics = reordered(statistics, splat_statistic::count, order);
    *this = std::move(sorted);
  }
};

}  // namespace tureen::trainer
