// The splats of one layer, of any kernel, in the tile renderer.
#pragma once

#include <utility>
#include <vector>

#include "splatting/kernel.hpp"
#include "splatting/layer.hpp"

namespace tureen::splatting {

/// `Kernel`: see KernelFunctions.
template <class Kernel>
class KernelLayer final : public Layer {
 public:
  explicit KernelLayer(LayerData data) : Layer(std::move(data)), projected_(count()) {}

  std::span<const float> project(const ImageView& view) override {
    functions_.project(view, data().rows, data().degree, 0, count(), projected_);
    return projected_.depths();
  }
  void set_order(std::span<const std::uint32_t> splats) override {
    order_.assign(splats.begin(), splats.end());
    entries_.resize(splats.size());
    outlines_.resize(splats.size());
    for (std::size_t place = 0; place < splats.size(); ++place)
      Kernel::read(projected_, splats[place], entries_[place], outlines_[place]);
  }
  void list(std::uint32_t begin, std::uint32_t end, std::uint32_t tag,
            TileLists& lists) const override {
    for (std::uint32_t place = begin; place < end; ++place)
      Kernel::list(entries_[place], outlines_[place], tag | place, lists);
  }
  void blend(const ImageView& view, std::span<const std::uint32_t> splats,
             TilePixels& pixels) const override {
    functions_.blend(view, entries_, splats, pixels);
  }
  void collect(const ImageView& view, std::span<const std::uint32_t> splats,
               const TilePixels& pixels, TileHits& hits) const override {
    functions_.collect(view, data().rows, order_, entries_, splats, pixels, hits);
  }

 private:
  const KernelFunctions<Kernel>& functions_ = Kernel::functions();
  typename Kernel::Projected projected_;
  std::vector<std::uint32_t> order_;  // of blending
  std::vector<typename Kernel::Entry> entries_;
  std::vector<typename Kernel::Outline> outlines_;
};

}  // namespace tureen::splatting
