// Collects the splats of a file. All readers of splats share it, and with it the rules for values
// that are invalid, the order of splats, and what the formats leave out.
#pragma once

#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <string>

#include "base/input.hpp"
#include "scene/scene.hpp"

namespace tureen {

/// One splat after activation.
struct SplatValues {
  glm::dvec3 center{0.0};
  glm::dvec3 scales{1.0};                   // or semi-axes, in layer units
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};  // layer from local coordinates, of any length but 0
  double opacity = 1;                       // not for neural densities
};

class SplatBuilder {
 public:
  enum class Kind { gaussians, flat_gaussians, neural_densities };

  /// Takes the memory of `count` splats from the input's budget. The caller has checked that the
  /// input can hold them. Throws InputError for 2^32 splats or more.
  SplatBuilder(Input& input, Kind kind, int degree, std::uint64_t count);

  /// Rounds the values to float and adds the splat. Drops it if a value is NaN, or a scale
  /// negative; if a centre, a scale, a coefficient or a network parameter is infinite; if the
  /// quaternion is 0; or if a semi-axis of a neural density is not positive. `coefficients`:
  /// harmonics::count(degree). `network`: NeuralDensities::parameters floats, or none.
  void add(const SplatValues& splat, std::span<const glm::vec3> coefficients,
           std::span<const float> network = {});

  /// A scene with the splats in Morton order, up -y (assumed, as in COLMAP), and remarks.
  /// `profile` must fit the kind. `format` is its name in sentences.
  Scene finish(const SplatProfile& profile, const std::string& format);

 private:
  bool is_valid(const SplatValues& splat, std::span<const glm::vec3> coefficients,
                std::span<const float> network) const;

  Input& input_;
  Kind kind_;
  std::uint64_t added_ = 0, dropped_ = 0;
  Splats splats_;
};

/// The up axis of splat files: y points down in COLMAP.
inline constexpr glm::vec3 splat_up{0.0f, -1.0f, 0.0f};

}  // namespace tureen
