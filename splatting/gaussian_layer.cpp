#include "splatting/gaussian_layer.hpp"

#include <algorithm>
#include <cmath>

#include "splatting/gaussian_rows.hpp"

namespace tureen::splatting {

GaussianLayer::GaussianLayer(const Gaussians& gaussians, const SplatColor& color,
                             std::span<const std::uint32_t> which, int degree)
    : degree_(degree),
      rows_(rows_of(gaussians, color, which, degree)),
      projected_(projected_gaussian_row::count, which.size()) {}

std::span<const float> GaussianLayer::project(const ImageView& view) {
  project_gaussians(view, rows_, degree_, projected_);
  return {projected_.row(projected_gaussian_row::depth), count()};
}

void GaussianLayer::set_order(std::span<const std::uint32_t> splats) {
  namespace row = projected_gaussian_row;
  entries_.resize(splats.size());
  outlines_.resize(splats.size());
  for (std::size_t place = 0; place < splats.size(); ++place) {
    const auto value = [&, i = splats[place]](std::size_t which) {
      return projected_.row(which)[i];
    };
    entries_[place] = {value(row::x),           value(row::y),     value(row::p),
                       value(row::q),           value(row::r),     value(row::log_opacity),
                       value(row::red),         value(row::green), value(row::blue),
                       1.0f / value(row::depth)};
    outlines_[place] = {value(row::half_width), value(row::half_height)};
  }
}

void GaussianLayer::list(const ImageView& view, std::uint32_t begin, std::uint32_t end,
                         std::uint32_t tag, TileLists& lists) const {
  const float min_log_alpha = std::log2(view.min_alpha);
  for (std::uint32_t place = begin; place < end; ++place) {
    const GaussianEntry& entry = entries_[place];
    const auto [half_width, half_height] = outlines_[place];
    const auto [first, last] = lists.rows_between(entry.y - half_height, entry.y + half_height);
    if (last - first == 1) {
      lists.add(first, entry.x - half_width, entry.x + half_width, tag | place);
      continue;
    }
    // The outline is dx = -slope dy +- sqrt(excess - (r dy)^2) / p. It is farthest to the right at
    // dy = -extreme, and farthest to the left at extreme.
    const float excess = entry.log_opacity - min_log_alpha;
    const float slope = entry.q / entry.p;
    const float extreme = half_height * entry.q / std::hypot(entry.q, entry.r);
    const auto half_width_at = [&](float dy) {
      return std::sqrt(std::max(excess - entry.r * entry.r * dy * dy, 0.0f)) / entry.p;
    };
    for (int row = first; row < last; ++row) {
      const Band band = TileLists::band(row);
      const float low = std::max(band.low - entry.y, -half_height);
      const float high = std::min(band.high - entry.y, half_height);
      const float right_at = std::min(std::max(-extreme, low), high);
      const float left_at = std::min(std::max(extreme, low), high);
      lists.add(row, entry.x - slope * left_at - half_width_at(left_at),
                entry.x - slope * right_at + half_width_at(right_at), tag | place);
    }
  }
}

void GaussianLayer::blend(const ImageView& view, std::span<const std::uint32_t> splats,
                          TilePixels& pixels) const {
  blend_gaussians(view, entries_, splats, pixels);
}

}  // namespace tureen::splatting
