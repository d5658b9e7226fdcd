#include "cli/heat_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include "soup/metrics.hpp"

namespace tureen::cli {

glm::u8vec4 heat(float difference) {
  // Lightness grows from stop to stop, so that the scale reads in grey as well.
  constexpr std::array<glm::vec3, 5> stops{{{0.18f, 0.05f, 0.38f},
                                            {0.58f, 0.10f, 0.42f},
                                            {0.90f, 0.28f, 0.20f},
                                            {0.99f, 0.72f, 0.22f},
                                            {1.00f, 1.00f, 1.00f}}};
  constexpr float smallest = 1.0f / 255.0f;
  // Half a step: what rounds to no difference in 8 bits shows as none.
  if (!(difference > 0.5f * smallest)) return {0, 0, 0, 255};
  const float t = std::clamp(1.0f - std::log(difference) / std::log(smallest), 0.0f, 1.0f) *
                  float(stops.size() - 1);
  const auto below = std::min(std::size_t(t), stops.size() - 2);
  const glm::vec3 color = glm::mix(stops[below], stops[below + 1], t - float(below));
  return glm::u8vec4(glm::vec4(color, 1.0f) * 255.0f + 0.5f);
}

Image8 side_by_side(const ImageF& a, const ImageF& b) {
  const std::vector<float> differences = difference_map(a, b);
  const Image8 left = quantised(a), middle = quantised(b);
  Image8 result(3 * a.width, a.height);
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      result.at(x, y) = left.at(x, y);
      result.at(a.width + x, y) = middle.at(x, y);
      result.at(2 * a.width + x, y) = heat(differences[std::size_t(y) * a.width + x]);
    }
  return result;
}

}  // namespace tureen::cli
