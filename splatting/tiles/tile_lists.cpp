#include "splatting/tiles/tile_lists.hpp"

#include <algorithm>

namespace tureen::splatting {

namespace {

/// The tiles with pixel centres between two coordinates along one axis. Centres lie half a pixel
/// inside their tile. NaN: none.
std::pair<int, int> tiles_between(float low, float high, int count) {
  constexpr float tiles_a_pixel = 1.0f / float(tile_side);
  const float first = (low + 0.5f) * tiles_a_pixel, last = (high - 0.5f) * tiles_a_pixel;
  if (!(last >= 0.0f && first < float(count))) return {0, 0};
  // Positive numbers are rounded down.
  const int begin = first > 0.0f ? int(first) : 0;
  const int end = int(std::min(last, float(count - 1))) + 1;
  return {begin, end};
}

}  // namespace

void TileLists::begin(int width, int height) {
  pairs_ = 0;
  columns_ = (width + tile_side - 1) / tile_side;
  const auto rows = std::size_t((height + tile_side - 1) / tile_side);
  spans_.resize(rows);
  lists_.resize(rows);
  for (std::vector<Span>& spans : spans_) spans.clear();
}

std::pair<int, int> TileLists::rows_between(float low, float high) const {
  return tiles_between(low, high, rows());
}

std::pair<int, int> TileLists::columns_between(float low, float high) const {
  return tiles_between(low, high, columns_);
}

void TileLists::add(int row, float low, float high, std::uint32_t splat) {
  const auto [first, last] = columns_between(low, high);
  add_columns(row, first, last, splat);
}

void TileLists::add(const Box& box, std::uint32_t splat) {
  const auto [first, last] = rows_between(box.top, box.bottom);
  const auto [begin, end] = columns_between(box.left, box.right);
  for (int row = first; row < last; ++row) add_columns(row, begin, end, splat);
}

void TileLists::add_everywhere(std::uint32_t splat) {
  for (int row = 0; row < rows(); ++row) add_columns(row, 0, columns_, splat);
}

template <bool numbered>
void TileLists::finish_row(int row, std::span<const std::uint32_t> shifts) {
  const std::vector<Span>& spans = spans_[std::size_t(row)];
  Lists& lists = lists_[std::size_t(row)];
  // Lengths as sums of differences: +1 where a span begins, -1 where it ends.
  std::vector<std::uint32_t>& starts = lists.starts;
  starts.assign(std::size_t(columns_) + 2, 0);
  for (const Span& span : spans) {
    ++starts[span.first + 1u];
    --starts[span.last + 1u];
  }
  std::uint32_t length = 0, sum = 0;
  for (std::size_t i = 1; i < starts.size(); ++i) {
    length += starts[i];
    starts[i] = sum;  // the place of the next splat of column i - 1
    sum += length;
  }
  lists.splats.resize(sum);
  if constexpr (numbered) lists.numbers.resize(sum);
  for (const Span& span : spans)
    for (std::uint32_t column = span.first; column < span.last; ++column) {
      const std::uint32_t place = starts[column + 1]++;
      lists.splats[place] = span.splat;
      if constexpr (numbered)
        lists.numbers[place] = span.number + (column - span.first) + shifts[span.splat];
    }
}

void TileLists::finish(int row) { finish_row<false>(row, {}); }
void TileLists::finish_with_numbers(int row, std::span<const std::uint32_t> shifts) {
  finish_row<true>(row, shifts);
}

}  // namespace tureen::splatting
