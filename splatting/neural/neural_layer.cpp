#include "splatting/neural/neural_layer.hpp"

#include <utility>

#include "splatting/harmonics_rows.hpp"

namespace tureen::splatting {

ParameterRows rows_of(const NeuralDensities& densities, const SplatColor& color,
                      std::span<const std::uint32_t> which, int degree) {
  namespace row = neural_row;
  ParameterRows rows(row::harmonics + harmonics_rows(degree), which.size());
  for (std::size_t i = 0; i < which.size(); ++i) {
    const std::uint32_t splat = which[i];
    for (int axis = 0; axis < 3; ++axis) {
      rows.row(row::center + std::size_t(axis))[i] = densities.centers[splat][axis];
      rows.row(row::semi_axes + std::size_t(axis))[i] = densities.semi_axes[splat][axis];
    }
    const glm::quat& rotation = densities.rotations[splat];
    rows.row(row::rotation)[i] = rotation.x;
    rows.row(row::rotation + 1)[i] = rotation.y;
    rows.row(row::rotation + 2)[i] = rotation.z;
    rows.row(row::rotation + 3)[i] = rotation.w;
    // The rows have the order of the network's values.
    const float* network = &densities.networks[NeuralDensities::parameters * splat];
    for (std::size_t k = 0; k < NeuralDensities::parameters; ++k) {
      const std::size_t at = row::frequencies + k;
      rows.row(at)[i] = at < row::amplitudes ? densities.omega * network[k] : network[k];
    }
  }
  write_harmonics(color, which, degree, rows, row::harmonics);
  return rows;
}

NeuralLayer::NeuralLayer(LayerData data)
    : Layer(std::move(data)), projected_(projected_neural_row::count, count()) {}

std::span<const float> NeuralLayer::project(const ImageView& view) {
  project_densities(view, data().rows, data().degree, 0, count(), projected_);
  return {projected_.row(projected_neural_row::depth), count()};
}

void NeuralLayer::set_order(std::span<const std::uint32_t> splats) {
  entries_.resize(splats.size());
  outlines_.resize(splats.size());
  for (std::size_t place = 0; place < splats.size(); ++place)
    read_density(projected_, splats[place], entries_[place], outlines_[place]);
}

void NeuralLayer::list(const ImageView&, std::uint32_t begin, std::uint32_t end, std::uint32_t tag,
                       TileLists& lists) const {
  for (std::uint32_t place = begin; place < end; ++place)
    list_density(outlines_[place], tag | place, lists);
}

void NeuralLayer::blend(const ImageView& view, std::span<const std::uint32_t> splats,
                        TilePixels& pixels) const {
  blend_densities(view, entries_, splats, pixels);
}

void NeuralLayer::collect(const ImageView& view, std::span<const std::uint32_t> splats,
                          const TilePixels& pixels, TileHits& hits) const {
  collect_densities(view, entries_, splats, pixels, hits);
}

}  // namespace tureen::splatting
