#include "splatting/gaussians/gaussian_layer.hpp"

#include <cmath>
#include <utility>

namespace tureen::splatting {

GaussianLayer::GaussianLayer(LayerData data)
    : Layer(std::move(data)), projected_(count()), depths_(count()) {}

std::span<const float> GaussianLayer::project(const ImageView& view) {
  project_gaussians(view, data().rows, data().degree, 0, projected_);
  for (std::size_t i = 0; i < projected_.size(); ++i) depths_[i] = projected_[i].depth;
  return depths_;
}

void GaussianLayer::set_order(std::span<const std::uint32_t> splats) {
  order_.assign(splats.begin(), splats.end());
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

void GaussianLayer::collect(const ImageView& view, std::span<const std::uint32_t> splats,
                            const TilePixels& pixels, TileHits& hits) const {
  collect_gaussians(view, entries_, data().rows, order_, splats, pixels, hits);
}

}  // namespace tureen::splatting
