#include "trainer/splats/gaussian_parameters.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "splatting/gaussian_rows.hpp"
#include "splatting/harmonics_rows.hpp"
#include "trainer/splats/splat_order.hpp"

namespace tureen::trainer {

namespace row = splatting::gaussian_row;

const std::array<ParameterKind, 6> gaussian_parameter_kinds = {{
    {"centre", row::x, 3, Activation::identity, 3e-3f, 3e-5f, Inheritance::moved_apart},
    {"log scale", row::scale_x, 3, Activation::exponential, 4e-2f, 8e-3f, Inheritance::shortened},
    {"rotation", row::rotation_x, 4, Activation::unit_length, 1e-2f, 2e-3f, Inheritance::copied},
    {"opacity logit", row::opacity, 1, Activation::sigmoid, 1e-1f, 2e-2f, Inheritance::copied},
    {"harmonics of degree 0", row::harmonics, 3, Activation::identity, 2e-2f, 4e-3f,
     Inheritance::copied},
    {"other harmonics", row::harmonics + 3, 45, Activation::identity, 4e-3f, 8e-4f,
     Inheritance::copied},
}};

GaussianParameters::GaussianParameters(std::size_t count, int degree_of_harmonics)
    : degree(degree_of_harmonics),
      drawn(row::harmonics + splatting::harmonics_rows(degree_of_harmonics), count),
      raw(raw_rows, count) {}

GaussianParameters::GaussianParameters(const Gaussians& gaussians, const SplatColor& color,
                                       int degree_of_harmonics)
    : GaussianParameters(gaussians.centers.size(), degree_of_harmonics) {
  std::vector<std::uint32_t> all(count());
  std::iota(all.begin(), all.end(), 0u);
  const splatting::ParameterRows values =
      splatting::rows_of(gaussians, color, all, std::min(degree, color.degree));
  const std::size_t stored = row::harmonics + splatting::harmonics_rows(color.degree);
  for (std::size_t i = 0; i < count(); ++i) {
    for (std::size_t r = 0; r < std::min(rows(), stored); ++r) drawn.row(r)[i] = values.row(r)[i];
    for (std::size_t axis = 0; axis < 3; ++axis)
      trained(row::scale_x + axis)[i] =
          std::log(std::max(values.row(row::scale_x + axis)[i], 1e-30f));
    for (std::size_t k = 0; k < 4; ++k)
      trained(row::rotation_x + k)[i] = values.row(row::rotation_x + k)[i];
    const float opacity = std::clamp(values.row(row::opacity)[i], 0.001f, 0.999f);
    trained(row::opacity)[i] = std::log(opacity / (1 - opacity));
    activate(i);
  }
}

std::size_t GaussianParameters::rows() const {
  return row::harmonics + splatting::harmonics_rows(degree);
}

float* GaussianParameters::trained(std::size_t r) {
  return r >= first_raw && r < row::harmonics ? raw.row(r - first_raw) : drawn.row(r);
}

const float* GaussianParameters::trained(std::size_t r) const {
  return r >= first_raw && r < row::harmonics ? raw.row(r - first_raw) : drawn.row(r);
}

void GaussianParameters::activate(std::size_t i) {
  float squared = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const float value = trained(row::rotation_x + k)[i];
    squared += value * value;
  }
  for (std::size_t axis = 0; axis < 3; ++axis)
    drawn.row(row::scale_x + axis)[i] = std::exp(trained(row::scale_x + axis)[i]);
  for (std::size_t k = 0; k < 4; ++k)
    drawn.row(row::rotation_x + k)[i] = trained(row::rotation_x + k)[i] / std::sqrt(squared);
  drawn.row(row::opacity)[i] = 1 / (1 + std::exp(-trained(row::opacity)[i]));
}

void GaussianParameters::reorder(std::span<const std::uint32_t> order) {
  drawn = reordered(drawn, rows(), order);
  raw = reordered(raw, raw_rows, order);
}

Splats GaussianParameters::splats() const {
  Gaussians gaussians;
  SplatColor color{.degree = degree};
  const std::size_t coefficients = splatting::harmonics_rows(degree) / 3;
  for (std::size_t i = 0; i < count(); ++i) {
    const auto value = [&](std::size_t r) { return drawn.row(r)[i]; };
    const auto triple = [&](std::size_t r) {
      return glm::vec3(value(r), value(r + 1), value(r + 2));
    };
    gaussians.centers.push_back(triple(row::x));
    gaussians.scales.push_back(triple(row::scale_x));
    gaussians.rotations.emplace_back(value(row::rotation_w), value(row::rotation_x),
                                     value(row::rotation_y), value(row::rotation_z));
    gaussians.opacity.push_back(value(row::opacity));
    for (std::size_t k = 0; k < coefficients; ++k)
      color.coefficients.push_back(triple(row::harmonics + 3 * k));
  }
  return {
      .kernel = std::move(gaussians), .color = std::move(color), .profile = *profile_named("3dgs")};
}

}  // namespace tureen::trainer
