// Discs on their planes in the tile renderer.
#pragma once

#include <vector>

#include "splatting/discs/disc_kernels.hpp"
#include "splatting/layer.hpp"

namespace tureen::splatting {

class DiscLayer final : public Layer {
 public:
  explicit DiscLayer(LayerData data);

  std::span<const float> project(const ImageView& view) override;
  void set_order(std::span<const std::uint32_t> splats) override;
  void list(const ImageView& view, std::uint32_t begin, std::uint32_t end, std::uint32_t tag,
            TileLists& lists) const override;
  void blend(const ImageView& view, std::span<const std::uint32_t> splats,
             TilePixels& pixels) const override;
  void collect(const ImageView& view, std::span<const std::uint32_t> splats,
               const TilePixels& pixels, TileHits& hits) const override;

 private:
  ParameterRows projected_;
  std::vector<DiscEntry> entries_;  // in the order of blending
  std::vector<Box> boxes_;          // of the entries
};

}  // namespace tureen::splatting
