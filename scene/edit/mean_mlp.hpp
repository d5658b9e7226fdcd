// The mean colour of a color MLP over all directions in which a point is visible.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "scene/color_mlp.hpp"

namespace tureen {

/// V. I. Lebedev's 26-point rule on the sphere, exact for polynomials up to degree 7: the axes, the
/// edge midpoints and the corners of a cube. The weights sum to 1.
struct WeightedDirection {
  glm::vec3 d;
  float weight;
};
std::array<WeightedDirection, 26> lebedev26();

/// The color MLP of one point for a fixed list of directions, in float. The directions' part of the
/// first layer is the same for every point, and the features' part is the same for every direction,
/// so each is computed once.
class MlpOverDirections {
 public:
  /// Largest number of directions.
  static constexpr int max_directions = 32;

  /// `to_eye` are unit directions from the surface to the eye. The network must outlive this.
  MlpOverDirections(const ColorMlp& mlp, std::span<const glm::vec3> to_eye);

  int count() const { return count_; }

  /// The network's output, one colour a direction, not blended with the features. `features` holds
  /// at least mlp.feature_count() values.
  void predict(std::span<const float> features, std::span<glm::vec3> colors) const;

 private:
  using OfDirections = std::array<float, max_directions>;

  const ColorMlp& mlp_;
  int count_;
  /// The first layer without its features, one row an output.
  std::vector<OfDirections> direction_part_;
};

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
