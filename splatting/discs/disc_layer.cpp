#include "splatting/discs/disc_layer.hpp"

#include <utility>

#include "splatting/discs/disc_entries.hpp"

namespace tureen::splatting {

DiscLayer::DiscLayer(LayerData data)
    : Layer(std::move(data)), projected_(projected_disc_row::count, count()) {}

std::span<const float> DiscLayer::project(const ImageView& view) {
  project_discs(view, data().rows, data().degree, 0, count(), projected_);
  return {projected_.row(projected_disc_row::depth), count()};
}

void DiscLayer::set_order(std::span<const std::uint32_t> splats) {
  entries_.resize(splats.size());
  boxes_.resize(splats.size());
  for (std::size_t place = 0; place < splats.size(); ++place) {
    entries_[place] = disc_entry(projected_, splats[place]);
    boxes_[place] = disc_box(projected_, splats[place]);
  }
}

void DiscLayer::list(const ImageView&, std::uint32_t begin, std::uint32_t end, std::uint32_t tag,
                     TileLists& lists) const {
  for (std::uint32_t place = begin; place < end; ++place) lists.add(boxes_[place], tag | place);
}

void DiscLayer::blend(const ImageView& view, std::span<const std::uint32_t> splats,
                      TilePixels& pixels) const {
  blend_discs(view, entries_, splats, pixels);
}

void DiscLayer::collect(const ImageView& view, std::span<const std::uint32_t> splats,
                        const TilePixels& pixels, TileHits& hits) const {
  collect_discs(view, entries_, splats, pixels, hits);
}

}  // namespace tureen::splatting
