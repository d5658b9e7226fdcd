// The mean colour of a color MLP over all directions in which a point is visible.
#pragma once

#include <array>
#include <glm/vec3.hpp>

#include "scene/edit/mlp_over_directions.hpp"

namespace tureen {

/// V. I. Lebedev's 26-point rule on the sphere, exact for polynomials up to degree 7: the axes, the
/// edge midpoints and the corners of a cube. The weights sum to 1.
struct WeightedDirection {
  glm::vec3 d;
  float weight;
};
std::array<WeightedDirection, 26> lebedev26();

class MeanMlp {
 public:
  /// The network must outlive this.
  explicit MeanMlp(const ColorMlp& mlp);

  /// Blended with the features as the network defines; not clamped.
  glm::vec3 operator()(const std::array<float, 8>& features) const;

 private:
  const ColorMlp& mlp_;
  MlpOverDirections over_;
  std::array<WeightedDirection, 26> rule_ = lebedev26();
};

}  // namespace tureen
