// Neural densities in the tile renderer.
#pragma once

#include <vector>

#include "splatting/layer.hpp"
#include "splatting/neural/neural_entries.hpp"

namespace tureen::splatting {

/// The rows of neural_row, for the densities with these indices and harmonics up to `degree`.
ParameterRows rows_of(const NeuralDensities& densities, const SplatColor& color,
                      std::span<const std::uint32_t> which, int degree);

class NeuralLayer final : public Layer {
 public:
  explicit NeuralLayer(LayerData data);

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
  std::vector<NeuralEntry> entries_;  // in the order of blending
  std::vector<Ellipse> outlines_;     // of the entries
};

}  // namespace tureen::splatting
