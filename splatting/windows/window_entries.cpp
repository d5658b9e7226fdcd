// Projected windows one by one: their entries for blending, and the tiles that each covers.
#include <algorithm>
#include <cmath>
#include <utility>

#include "splatting/windows/corner_window_kernels.hpp"
#include "splatting/windows/window_kernels.hpp"

namespace tureen::splatting {

namespace {

/// A triangle as the columns it covers in bands of rows. Its longest side in y spans both others.
class Columns {
 public:
  explicit Columns(const WindowOutline& outline) {
    Corner a{outline[0], outline[1]}, b{outline[2], outline[3]}, c{outline[4], outline[5]};
    if (b.y < a.y) std::swap(a, b);
    if (c.y < b.y) std::swap(b, c);
    if (b.y < a.y) std::swap(a, b);
    top_ = a, middle_ = b, bottom_ = c;
    across_ = slope(a, c), above_ = slope(a, b), below_ = slope(b, c);
  }

  /// The x coordinates of the part in a band that overlaps the triangle. Without branches: they are
  /// hard to predict.
  Band in(const Band& band) const {
    const float first = std::max(band.low, top_.y), last = std::min(band.high, bottom_.y);
    const float x[] = {across(first), across(last), around(first), around(last),
                       middle_.y >= first && middle_.y <= last ? middle_.x : across(first)};
    return {std::min(std::min(std::min(x[0], x[1]), std::min(x[2], x[3])), x[4]),
            std::max(std::max(std::max(x[0], x[1]), std::max(x[2], x[3])), x[4])};
  }

 private:
  struct Corner {
    float x, y;
  };
  /// dx/dy. 0 for level sides, whose ends the other sides have. A triangle without height covers no
  /// pixel centre.
  static float slope(const Corner& a, const Corner& b) {
    return b.y > a.y ? (b.x - a.x) / (b.y - a.y) : 0.0f;
  }
  float across(float y) const { return top_.x + across_ * (y - top_.y); }
  float around(float y) const {
    const bool is_above = y < middle_.y;
    return is_above ? top_.x + above_ * (y - top_.y) : middle_.x + below_ * (y - middle_.y);
  }

  Corner top_, middle_, bottom_;
  float across_, above_, below_;
};

void read_shape(const ParameterRows& projected, std::size_t i, WindowShape& entry,
                WindowOutline& outline) {
  namespace row = projected_window_row;
  const auto value = [&](std::size_t which) { return projected.row(which)[i]; };
  entry.x = value(row::x);
  entry.y = value(row::y);
  for (std::size_t k = 0; k < 9; ++k) entry.edges[k] = value(row::edges + k);
  for (std::size_t k = 0; k < 3; ++k) entry.inverse_depth[k] = value(row::inverse_depth + k);
  entry.sigma = value(row::sigma);
  entry.log_opacity = value(row::log_opacity);
  entry.min_rho = value(row::min_rho);
  for (std::size_t k = 0; k < 6; ++k) outline[k] = value(row::outline + k);
}

}  // namespace

void WindowKernel::read(const Projected& projected, std::size_t i, Entry& entry, Outline& outline) {
  namespace row = projected_window_row;
  const auto value = [&](std::size_t which) { return projected.row(which)[i]; };
  read_shape(projected, i, entry, outline);
  entry.red = value(row::red);
  entry.green = value(row::green);
  entry.blue = value(row::blue);
  entry.reaches_near = std::isnan(outline[0]);
}

void CornerWindowKernel::read(const Projected& projected, std::size_t i, Entry& entry,
                              Outline& outline) {
  namespace row = projected_corner_row;
  read_shape(projected, i, entry, outline);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto value = [&](std::size_t which) { return projected.row(which + k)[i]; };
    entry.weights[k] = value(row::weights);
    entry.red[k] = value(row::red);
    entry.green[k] = value(row::green);
    entry.blue[k] = value(row::blue);
  }
}

void list_window(const WindowOutline& outline, std::uint32_t splat, TileLists& lists) {
  if (std::isnan(outline[0])) {
    lists.add_everywhere(splat);
    return;
  }
  const auto [left, right] = std::minmax({outline[0], outline[2], outline[4]});
  const auto [top, bottom] = std::minmax({outline[1], outline[3], outline[5]});
  const auto [first, last] = lists.rows_between(top, bottom);
  const auto [begin, end] = lists.columns_between(left, right);
  // Most triangles are small. The whole range of columns is at most a little too wide.
  if (last - first <= 1 || end - begin <= 1) {
    for (int row = first; row < last; ++row) lists.add_columns(row, begin, end, splat);
    return;
  }
  const Columns columns(outline);
  for (int row = first; row < last; ++row) {
    const Band x = columns.in(TileLists::band(row));
    lists.add(row, x.low, x.high, splat);
  }
}

}  // namespace tureen::splatting
