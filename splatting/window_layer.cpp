#include "splatting/window_layer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "splatting/harmonics_rows.hpp"

namespace tureen::splatting {

namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();

/// The x coordinates of the part of a triangle in a band. Empty: low > high.
Band columns_in(const std::array<float, 6>& corners, const Band& band) {
  Band result{infinite, -infinite};
  const auto add = [&](float x) {
    result.low = std::min(result.low, x);
    result.high = std::max(result.high, x);
  };
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    const float ax = corners[2 * k], ay = corners[2 * k + 1];
    const float bx = corners[2 * next], by = corners[2 * next + 1];
    if (ay >= band.low && ay <= band.high) add(ax);
    for (const float y : {band.low, band.high})
      if ((ay < y) != (by < y)) add(ax + (bx - ax) * ((y - ay) / (by - ay)));
  }
  return result;
}

}  // namespace

WindowLayer::WindowLayer(const TriangleWindows& windows, const SplatColor& color,
                         std::span<const std::uint32_t> which, int degree)
    : degree_(degree),
      rows_(window_row::harmonics + harmonics_rows(degree), which.size()),
      projected_(projected_window_row::count, which.size()) {
  for (std::size_t i = 0; i < which.size(); ++i) {
    for (std::size_t k = 0; k < 9; ++k)
      rows_.row(window_row::corners + k)[i] = windows.corners[3 * which[i] + k / 3][int(k % 3)];
    rows_.row(window_row::sigma)[i] = windows.sigma[which[i]];
    rows_.row(window_row::opacity)[i] = windows.opacity[which[i]];
  }
  write_harmonics(color, which, degree, rows_, window_row::harmonics);
}

std::span<const float> WindowLayer::project(const ImageView& view) {
  project_windows(view, rows_, degree_, projected_);
  return {projected_.row(projected_window_row::depth), count()};
}

void WindowLayer::set_order(std::span<const std::uint32_t> splats) {
  namespace row = projected_window_row;
  entries_.resize(splats.size());
  outlines_.resize(splats.size());
  for (std::size_t place = 0; place < splats.size(); ++place) {
    const auto value = [&, i = splats[place]](std::size_t which) {
      return projected_.row(which)[i];
    };
    WindowEntry& entry = entries_[place];
    entry.x = value(row::x);
    entry.y = value(row::y);
    for (std::size_t k = 0; k < 9; ++k) entry.edges[k] = value(row::edges + k);
    for (std::size_t k = 0; k < 3; ++k) entry.inverse_depth[k] = value(row::inverse_depth + k);
    entry.sigma = value(row::sigma);
    entry.log_opacity = value(row::log_opacity);
    entry.min_rho = value(row::min_rho);
    entry.red = value(row::red);
    entry.green = value(row::green);
    entry.blue = value(row::blue);
    for (std::size_t k = 0; k < 6; ++k) outlines_[place][k] = value(row::outline + k);
  }
}

void WindowLayer::list(const ImageView&, std::uint32_t begin, std::uint32_t end, std::uint32_t tag,
                       TileLists& lists) const {
  for (std::uint32_t place = begin; place < end; ++place) {
    const std::array<float, 6>& outline = outlines_[place];
    if (std::isnan(outline[0])) {  // may cover any pixel
      for (int row = 0; row < lists.rows(); ++row) lists.add(row, 0, infinite, tag | place);
      continue;
    }
    const auto [low, high] = std::minmax({outline[1], outline[3], outline[5]});
    const auto [first, last] = lists.rows_between(low, high);
    for (int row = first; row < last; ++row) {
      const Band columns = columns_in(outline, TileLists::band(row));
      if (columns.low <= columns.high) lists.add(row, columns.low, columns.high, tag | place);
    }
  }
}

void WindowLayer::blend(const ImageView& view, std::span<const std::uint32_t> splats,
                        TilePixels& pixels) const {
  blend_windows(view, entries_, splats, pixels);
}

}  // namespace tureen::splatting
