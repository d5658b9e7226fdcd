// Neural densities in the tile renderer.
#pragma once

#include <vector>

#include "splatting/layer.hpp"
#include "splatting/neural_entries.hpp"

namespace tureen::splatting {

class NeuralLayer final : public Layer {
 public:
  NeuralLayer(const NeuralDensities& densities, const SplatColor& color,
              std::span<const std::uint32_t> which, int degree);

  std::size_t count() const override { return rows_.count(); }
  std::span<const float> project(const ImageView& view) override;
  void set_order(std::span<const std::uint32_t> splats) override;
  void list(const ImageView& view, std::uint32_t begin, std::uint32_t end, std::uint32_t tag,
            TileLists& lists) const override;
  void blend(const ImageView& view, std::span<const std::uint32_t> splats,
             TilePixels& pixels) const override;

 private:
  int degree_;
  ParameterRows rows_, projected_;
  std::vector<NeuralEntry> entries_;  // in the order of blending
  std::vector<Ellipse> outlines_;     // of the entries
};

}  // namespace tureen::splatting
