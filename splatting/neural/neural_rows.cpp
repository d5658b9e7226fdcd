#include "splatting/harmonics_rows.hpp"
#include "splatting/neural/neural_kernels.hpp"

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

}  // namespace tureen::splatting
