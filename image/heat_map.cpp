#include "image/heat_map.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>

#include "image/metrics.hpp"

namespace tureen {

glm::vec3 heat_ramp(float t) {
  // Same values as in shaders/debug_views/heat_ramp.glsl.
  constexpr std::array<glm::vec3, 5> stops{{{0.18f, 0.05f, 0.38f},
                                            {0.58f, 0.10f, 0.42f},
                                            {0.90f, 0.28f, 0.20f},
                                            {0.99f, 0.72f, 0.22f},
                                            {1.00f, 1.00f, 1.00f}}};
  const float at = std::clamp(t, 0.0f, 1.0f) * float(stops.size() - 1);
  const auto below = std::min(std::size_t(at), stops.size() - 2);
  return glm::mix(stops[below], stops[below + 1], at - float(below));
}

glm::u8vec4 heat(float difference) {
  constexpr float smallest = 1.0f / 255.0f;
  // Below half an 8-bit step, a difference counts as none.
  if (!(difference > 0.5f * smallest)) return {0, 0, 0, 255};
  const glm::vec3 color = heat_ramp(1.0f - std::log(difference) / std::log(smallest));
  return glm::u8vec4(glm::vec4(color, 1.0f) * 255.0f + 0.5f);
}

Image8 difference(const ImageF& a, const ImageF& b) {
  const std::vector<float> differences = difference_map(a, b);
  Image8 result(a.width, a.height);
  for (std::size_t i = 0; i < differences.size(); ++i) result.pixels[i] = heat(differences[i]);
  return result;
}

Legend difference_legend() {
  Legend entries;
  for (const int step : {0, 1, 2, 4, 8, 16, 32, 64, 128, 255})
    entries.push_back({heat(float(step) / 255.0f), std::to_string(step) + "/255"});
  return entries;
}

Image8 side_by_side(std::span<const Image8> images) {
  int width = 0;
  for (const Image8& image : images) {
    assert(image.height == images.front().height);
    width += image.width;
  }
  Image8 result(width, images.front().height);
  int x = 0;
  for (const Image8& image : images) {
    for (int y = 0; y < image.height; ++y)
      std::copy_n(&image.at(0, y), image.width, &result.at(x, y));
    x += image.width;
  }
  return result;
}

Image8 side_by_side(const ImageF& a, const ImageF& b) {
  const Image8 images[] = {quantised(a), quantised(b), difference(a, b)};
  return side_by_side(images);
}

}  // namespace tureen
