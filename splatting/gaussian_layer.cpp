#include "splatting/gaussian_layer.hpp"

#include <cmath>

#include "splatting/gaussian_rows.hpp"

namespace tureen::splatting {

GaussianLayer::GaussianLayer(const Gaussians& gaussians, const SplatColor& color,
                             std::span<const std::uint32_t> which, int degree)
    : degree_(degree),
      rows_(rows_of(gaussians, color, which, degree)),
      projected_(which.size()),
      depths_(which.size()) {}

std::span<const float> GaussianLayer::project(const ImageView& view) {
  project_gaussians(view, rows_, degree_, 0, projected_);
  for (std::size_t i = 0; i < projected_.size(); ++i) depths_[i] = projected_[i].depth;
  return depths_;
}

void GaussianLayer::set_order(std::span<const std::uint32_t> splats) {
  entries_.resize(splats.size());
  for (std::size_t place = 0; place < splats.size(); ++place)
    entries_[place] = projected_[splats[place]];
}

void GaussianLayer::list(const ImageView& view, std::uint32_t begin, std::uint32_t end,
                         std::uint32_t tag, TileLists& lists) const {
  const float min_log_alpha = std::log2(view.min_alpha);
  for (std::uint32_t place = begin; place < end; ++place)
    list_gaussian(entries_[place], min_log_alpha, tag | place, lists);
}

void GaussianLayer::blend(const ImageView& view, std::span<const std::uint32_t> splats,
                          TilePixels& pixels) const {
  blend_gaussians(view, entries_, splats, pixels);
}

}  // namespace tureen::splatting
