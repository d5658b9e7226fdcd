// Gaussians by EWA splatting in the tile renderer.
#pragma once

#include <vector>

#include "splatting/gaussians/gaussian_entries.hpp"
#include "splatting/layer.hpp"

namespace tureen::splatting {

class GaussianLayer final : public Layer {
 public:
  explicit GaussianLayer(LayerData data);

  std::span<const float> project(const ImageView& view) override;
  void set_order(std::span<const std::uint32_t> splats) override;
  void list(const ImageView& view, std::uint32_t begin, std::uint32_t end, std::uint32_t tag,
            TileLists& lists) const override;
  void blend(const ImageView& view, std::span<const std::uint32_t> splats,
             TilePixels& pixels) const override;
  void collect(const ImageView& view, std::span<const std::uint32_t> splats,
               const TilePixels& pixels, TileHits& hits) const override;

 private:
  std::vector<GaussianEntry> projected_;
  std::vector<float> depths_;
  std::vector<GaussianEntry> entries_;  // in the order of blending
  std::vector<std::uint32_t> order_;    // their indices
};

}  // namespace tureen::splatting
