#include "trainer/splats/windows/window_parameters.hpp"

#include <algorithm>
#include <cmath>

namespace tureen::trainer {

namespace window_row = splatting::window_row;

const std::array<ParameterKind, 5> window_parameter_kinds = {{
    {"corners", window_row::corners, 9, 8e-3f, 8e-5f},
    {"log sigma", window_row::sigma, 1, 1e-2f, 2e-3f},
    {"opacity logit", window_row::opacity, 1, 3e-2f, 1e-2f},
    {"harmonics of degree 0", window_row::harmonics, 3, 5e-3f, 1e-3f},
    {"other harmonics", window_row::harmonics + 3, 45, 5e-4f, 1e-4f},
}};

WindowParameters::WindowParameters(const Splats& splats, int degree_of_harmonics)
    : SplatParameters(splats, degree_of_harmonics) {
  for (std::size_t i = 0; i < count(); ++i) {
    trained(window_row::sigma)[i] = log_of_sigma(drawn.row(window_row::sigma)[i]);
    trained(window_row::opacity)[i] = logit_of(opacity(i));
    activate(i);
  }
}

void WindowParameters::activate(std::size_t i) {
  drawn.row(window_row::sigma)[i] = sigma_floor + std::exp(trained(window_row::sigma)[i]);
  drawn.row(window_row::opacity)[i] =
      solidity + (1 - solidity) / (1 + std::exp(-trained(window_row::opacity)[i]));
}

float WindowParameters::log_of_sigma(float sigma) {
  return std::log(std::max(sigma, 1.01f * sigma_floor) - sigma_floor);
}

float WindowParameters::logit_of(float opacity) const {
  const float fraction = std::clamp((opacity - solidity) / (1 - solidity), 0.001f, 0.999f);
  return std::log(fraction / (1 - fraction));
}

Splats WindowParameters::splats() const {
  TriangleWindows windows;
  for (std::size_t i = 0; i < count(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) windows.corners.push_back(corner(i, k));
    windows.sigma.push_back(drawn.row(window_row::sigma)[i]);
    windows.opacity.push_back(opacity(i));
  }
  return {.kernel = std::move(windows),
          .color = color(),
          .profile = *profile_named("triangle-splatting")};
}

}  // namespace tureen::trainer
