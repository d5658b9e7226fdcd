// The color MLP of one point for a fixed list of directions, in float, for colours from many
// directions at once. The directions' part of the first layer is the same for every point, and the
// features' part is the same for every direction, so each is computed once.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "scene/color_mlp.hpp"

namespace tureen {

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

}  // namespace tureen
