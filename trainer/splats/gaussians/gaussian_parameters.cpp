#include "trainer/splats/gaussians/gaussian_parameters.hpp"

#include <algorithm>
#include <cmath>

namespace tureen::trainer {

namespace row = splatting::gaussian_row;

const std::array<ParameterKind, 6> gaussian_parameter_kinds = {{
    {"centre", row::x, 3, 3e-3f, 3e-5f},
    {"log scale", row::scale_x, 3, 4e-2f, 8e-3f},
    {"rotation", row::rotation_x, 4, 1e-2f, 2e-3f},
    {"opacity logit", row::opacity, 1, 1e-1f, 2e-2f},
    {"harmonics of degree 0", row::harmonics, 3, 2e-2f, 4e-3f},
    {"other harmonics", row::harmonics + 3, 45, 4e-3f, 8e-4f},
}};

GaussianParameters::GaussianParameters(const Splats& splats, int degree_of_harmonics)
    : SplatParameters(splats, degree_of_harmonics) {
  for (std::size_t i = 0; i < count(); ++i) {
    for (std::size_t r = row::scale_x; r <= row::scale_z; ++r)
      trained(r)[i] = std::log(std::max(drawn.row(r)[i], 1e-30f));
    for (std::size_t r = row::rotation_x; r <= row::rotation_w; ++r)
      trained(r)[i] = drawn.row(r)[i];
    const float opacity = std::clamp(drawn.row(row::opacity)[i], 0.001f, 0.999f);
    trained(row::opacity)[i] = std::log(opacity / (1 - opacity));
    activate(i);
  }
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

Splats GaussianParameters::splats(bool flat) const {
  Gaussians gaussians;
  gaussians.flat = flat;
  for (std::size_t i = 0; i < count(); ++i) {
    const auto value = [&](std::size_t r) { return drawn.row(r)[i]; };
    gaussians.centers.push_back(center(i));
    const glm::vec3 scales = triple(row::scale_x, i);
    gaussians.scales.emplace_back(scales.x, scales.y, flat ? 0 : scales.z);
    gaussians.rotations.emplace_back(value(row::rotation_w), value(row::rotation_x),
                                     value(row::rotation_y), value(row::rotation_z));
    gaussians.opacity.push_back(opacity(i));
  }
  return {.kernel = std::move(gaussians),
          .color = color(),
          .profile = *profile_named(flat ? "2dgs" : "3dgs")};
}

}  // namespace tureen::trainer
