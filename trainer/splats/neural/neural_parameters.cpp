#include "trainer/splats/neural/neural_parameters.hpp"

#include <algorithm>
#include <cmath>

namespace tureen::trainer {

namespace neural_row = splatting::neural_row;

const std::array<ParameterKind, 9> neural_parameter_kinds = {{
    {"centre", neural_row::center, 3, 1e-3f, 5e-5f},
    {"log semi-axis", neural_row::semi_axes, 3, 1.5e-2f, 7.5e-4f},
    {"rotation", neural_row::rotation, 4, 1e-2f, 5e-4f},
    {"frequencies", neural_row::frequencies, 24, 1.5e-1f, 7.5e-3f},
    {"phases", neural_row::phases, 8, 1.5e-1f, 7.5e-3f},
    {"amplitudes", neural_row::amplitudes, 8, 1e-1f, 5e-3f},
    {"offset", neural_row::offset, 1, 1e-1f, 5e-3f},
    {"harmonics of degree 0", neural_row::harmonics, 3, 2e-2f, 1e-3f},
    {"other harmonics", neural_row::harmonics + 3, 45, 4e-3f, 2e-4f},
}};

NeuralParameters::NeuralParameters(const Splats& splats, int degree_of_harmonics)
    : SplatParameters(splats, degree_of_harmonics) {
  for (std::size_t i = 0; i < count(); ++i) {
    for (std::size_t r = neural_row::semi_axes; r < neural_row::rotation; ++r)
      trained(r)[i] = std::log(std::max(drawn.row(r)[i], 1e-30f));
    for (std::size_t r = neural_row::rotation; r < neural_row::frequencies; ++r)
      trained(r)[i] = drawn.row(r)[i];
    activate(i);
  }
}

void NeuralParameters::activate(std::size_t i) {
  for (std::size_t r = neural_row::semi_axes; r < neural_row::rotation; ++r)
    drawn.row(r)[i] = std::exp(trained(r)[i]);
  float squared = 0;
  for (std::size_t r = neural_row::rotation; r < neural_row::frequencies; ++r)
    squared += trained(r)[i] * trained(r)[i];
  for (std::size_t r = neural_row::rotation; r < neural_row::frequencies; ++r)
    drawn.row(r)[i] = trained(r)[i] / std::sqrt(squared);
}

Splats NeuralParameters::splats() const {
  NeuralDensities densities;
  for (std::size_t i = 0; i < count(); ++i) {
    const auto value = [&](std::size_t r) { return drawn.row(r)[i]; };
    densities.centers.push_back(center(i));
    densities.semi_axes.push_back(triple(neural_row::semi_axes, i));
    densities.rotations.emplace_back(value(neural_row::rotation + 3), value(neural_row::rotation),
                                     value(neural_row::rotation + 1),
                                     value(neural_row::rotation + 2));
    for (std::size_t r = neural_row::frequencies; r < neural_row::harmonics; ++r)
      densities.networks.push_back(r < neural_row::amplitudes ? value(r) / densities.omega
                                                              : value(r));
  }
  return {.kernel = std::move(densities), .color = color(), .profile = *profile_named("splatnet")};
}

}  // namespace tureen::trainer
