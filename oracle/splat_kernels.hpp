// One splat of any kernel in the image of a camera, and its colour. Each kernel has its own file,
// with its equations.
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <variant>

#include "oracle/disc.hpp"
#include "oracle/ewa.hpp"
#include "oracle/neural_density.hpp"
#include "oracle/splat_sample.hpp"
#include "oracle/splat_view.hpp"
#include "oracle/window.hpp"
#include "scene/splats.hpp"

namespace tureen::oracle {

using SplatInView = std::variant<WindowInView, EwaInView, DiscInView, NeuralDensityInView>;

/// Splat `i`, or nullopt if no pixel can show it. `view` must outlive the result.
std::optional<SplatInView> project(const Splats& splats, std::size_t i, const SplatView& view);

/// The part of the splat in front of an opaque surface at `opaque_depth` (infinity without one): of
/// a neural density, the chord up to the surface; of others, all or nothing. Alpha is 0 if depth is
/// not less than `opaque_depth`. No value is NaN.
SplatSample sample(const SplatInView& splat, const glm::dvec2& pixel, double opaque_depth);

/// Contains every point of the image where alpha is above 0.
const ImageBox& box_of(const SplatInView& splat);

/// The colour of splat `i` seen from `eye`, in layer coordinates: 0 or more, may exceed 1. A centre
/// or corner at the eye uses the direction (0, 0, 1), as soups do.
class SplatColorInView {
 public:
  SplatColorInView(const Splats& splats, std::size_t i, const glm::dvec3& eye);

  /// At an image point where `splat`, the same splat, has a sample.
  glm::dvec3 at(const SplatInView& splat, const glm::dvec2& pixel) const;

 private:
  bool per_corner_;
  std::array<glm::dvec3, 3> colors_;  // of the corners; otherwise, the first is the splat's
};

}  // namespace tureen::oracle
