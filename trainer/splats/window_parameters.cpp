#include "trainer/splats/window_parameters.hpp"

#include <algorithm>
#include <cmath>

#include "splatting/harmonics_rows.hpp"
#include "trainer/splats/splat_order.hpp"

namespace tureen::trainer {

namespace window_row = splatting::window_row;

const std::array<ParameterKind, 5> window_parameter_kinds = {{
    {"corners", window_row::corners, 9, Activation::identity, 8e-3f, 8e-5f, Inheritance::halved},
    {"log sigma", window_row::sigma, 1, Activation::floored_exponential, 1e-2f, 2e-3f,
     Inheritance::copied},
    {"opacity logit", window_row::opacity, 1, Activation::sigmoid, 3e-2f, 1e-2f,
     Inheritance::copied},
    {"harmonics of degree 0", window_row::harmonics, 3, Activation::identity, 5e-3f, 1e-3f,
     Inheritance::copied},
    {"other harmonics", window_row::harmonics + 3, 45, Activation::identity, 5e-4f, 1e-4f,
     Inheritance::copied},
}};

WindowParameters::WindowParameters(std::size_t count, int degree_of_harmonics)
    : degree(degree_of_harmonics),
      drawn(window_row::harmonics + splatting::harmonics_rows(degree_of_harmonics), count),
      raw(raw_rows, count) {}

WindowParameters::WindowParameters(const TriangleWindows& windows, const SplatColor& color,
                                   int degree_of_harmonics)
    : WindowParameters(windows.sigma.size(), degree_of_harmonics) {
  const auto stored = std::size_t(harmonics::count(color.degree));
  const auto used = std::min(stored, std::size_t(harmonics::count(degree)));
  for (std::size_t i = 0; i < count(); ++i) {
    for (std::size_t k = 0; k < 9; ++k)
      trained(window_row::corners + k)[i] = windows.corners[3 * i + k / 3][int(k % 3)];
    trained(window_row::sigma)[i] = log_of_sigma(windows.sigma[i]);
    trained(window_row::opacity)[i] = logit_of(windows.opacity[i]);
    for (std::size_t k = 0; k < used; ++k)
      for (int channel = 0; channel < 3; ++channel)
        trained(window_row::harmonics + 3 * k + std::size_t(channel))[i] =
            color.coefficients[stored * i + k][channel];
    activate(i);
  }
}

std::size_t WindowParameters::rows() const {
  return window_row::harmonics + splatting::harmonics_rows(degree);
}

float* WindowParameters::trained(std::size_t r) {
  return r >= first_raw && r < window_row::harmonics ? raw.row(r - first_raw) : drawn.row(r);
}

const float* WindowParameters::trained(std::size_t r) const {
  return r >= first_raw && r < window_row::harmonics ? raw.row(r - first_raw) : drawn.row(r);
}

void WindowParameters::activate(std::size_t i) {
  drawn.row(window_row::sigma)[i] = sigma_floor + std::exp(trained(window_row::sigma)[i]);
  drawn.row(window_row::opacity)[i] =
      min_opacity + (1 - min_opacity) / (1 + std::exp(-trained(window_row::opacity)[i]));
}

float WindowParameters::log_of_sigma(float sigma) {
  return std::log(std::max(sigma, 1.01f * sigma_floor) - sigma_floor);
}

float WindowParameters::logit_of(float opacity) const {
  const float fraction = std::clamp((opacity - min_opacity) / (1 - min_opacity), 0.001f, 0.999f);
  return std::log(fraction / (1 - fraction));
}

void WindowParameters::reorder(std::span<const std::uint32_t> order) {
  drawn = reordered(drawn, rows(), order);
  raw = reordered(raw, raw_rows, order);
}

Splats WindowParameters::splats() const {
  TriangleWindows windows;
  SplatColor color{.degree = degree};
  const auto coefficients = std::size_t(harmonics::count(degree));
  for (std::size_t i = 0; i < count(); ++i) {
    const auto triple = [&](std::size_t r) {
      return glm::vec3(drawn.row(r)[i], drawn.row(r + 1)[i], drawn.row(r + 2)[i]);
    };
    for (std::size_t k = 0; k < 3; ++k)
      windows.corners.push_back(triple(window_row::corners + 3 * k));
    windows.sigma.push_back(drawn.row(window_row::sigma)[i]);
    windows.opacity.push_back(drawn.row(window_row::opacity)[i]);
    for (std::size_t k = 0; k < coefficients; ++k)
      color.coefficients.push_back(triple(window_row::harmonics + 3 * k));
  }
  return {.kernel = std::move(windows),
          .color = std::move(color),
          .profile = *profile_named("triangle-splatting")};
}

}  // namespace tureen::trainer
