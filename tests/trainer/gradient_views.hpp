// Shared by the tests of the gradients of splats: a small image, its camera, and noise as the
// derivatives of a loss.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "scene/camera.hpp"
#include "tests/support/random.hpp"

namespace tureen::trainer::test {

inline constexpr int width = 22, height = 19;  // no multiples of a tile
inline constexpr std::array<float, 3> background{0.2f, 0.5f, 0.9f};

inline Camera camera() {
  Camera result = look_at({0.3, -0.4, 4}, {0, 0, 0}, {0.1, 1, 0}, 0.7, width, height);
  result.fx *= 1.1;
  result.cx += 0.7;
  return result;
}

/// The trained values, splat after splat.
template <class Real, class Parameters>
std::vector<Real> values_of(const Parameters& parameters) {
  std::vector<Real> result;
  for (std::size_t i = 0; i < parameters.count(); ++i)
    for (std::size_t r = 0; r < parameters.rows(); ++r)
      result.emplace_back(double(parameters.trained(r)[i]));
  return result;
}

/// The derivatives of a loss by the image: noise.
inline std::vector<float> random_gradient(std::uint64_t seed) {
  tureen::test::Random random(seed);
  std::vector<float> result(3 * width * height);
  for (float& value : result) value = float(random.normal());
  return result;
}

}  // namespace tureen::trainer::test
