#include "image/specks.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec3.hpp>

namespace tureen {

namespace {

constexpr int reach = 2;  // pixels on each side of the middle
constexpr int window = (2 * reach + 1) * (2 * reach + 1);
/// Medians are computed for this many pixels of a row at once, in vectors.
constexpr int lanes = 16;
using Lanes = std::array<float, lanes>;

void sort_pair(Lanes& low, Lanes& high) {
  for (int i = 0; i < lanes; ++i) {
    const float a = low[i], b = high[i];
    low[i] = std::min(a, b);
    high[i] = std::max(a, b);
  }
}

/// Reorders values so that the smallest is first and the largest is last.
void move_extremes(Lanes* values, int count) {
  for (int i = 0; i < count / 2; ++i) sort_pair(values[i], values[count - 1 - i]);
  for (int i = 1; i < (count + 1) / 2; ++i) sort_pair(values[0], values[i]);
  for (int i = count / 2; i < count - 1; ++i) sort_pair(values[i], values[count - 1]);
}

/// The median in each lane. Among window / 2 + 2 values, neither the smallest nor the largest is
/// the median of all. Both are replaced: one by the next value, until none is left.
Lanes medians(std::array<Lanes, window>& values) {
  Lanes* first = values.data();
  int count = window / 2 + 2, next = count;
  while (count > 1) {
    move_extremes(first, count);
    if (next < window) {
      first[count - 1] = values[std::size_t(next++)];
    } else {
      --count;
    }
    ++first;
    --count;
  }
  return *first;
}

}  // namespace

std::vector<float> differences_from_median(const ImageF& image) {
  std::vector<float> result(image.pixels.size());
  const auto value = [&](int x, int y, int channel) {
    return image.at(std::clamp(x, 0, image.width - 1), std::clamp(y, 0, image.height - 1))[channel];
  };
  std::array<Lanes, window> values;
  for (int y = 0; y < image.height; ++y)
    for (int x0 = 0; x0 < image.width; x0 += lanes)
      for (int channel = 0; channel < 3; ++channel) {
        for (int k = 0; k < window; ++k)
          for (int i = 0; i < lanes; ++i)
            values[std::size_t(k)][std::size_t(i)] =
                value(x0 + i + k % 5 - reach, y + k / 5 - reach, channel);
        const Lanes median = medians(values);
        for (int i = 0; i < lanes && x0 + i < image.width; ++i) {
          float& largest = result[std::size_t(y) * std::size_t(image.width) + std::size_t(x0 + i)];
          largest = std::max(largest, std::abs(value(x0 + i, y, channel) - median[std::size_t(i)]));
        }
      }
  return result;
}

std::vector<float> speck_map(const ImageF& photograph, const ImageF& rendering) {
  assert(photograph.width == rendering.width && photograph.height == rendering.height);
  const std::vector<float> expected = differences_from_median(photograph);
  std::vector<float> map = differences_from_median(rendering);
  for (std::size_t i = 0; i < map.size(); ++i)
    map[i] = map[i] > speck_difference && expected[i] < calm_difference ? 1.0f : 0.0f;
  return map;
}

std::vector<float> hole_map(const ImageF& photograph, const ImageF& rendering) {
  assert(photograph.width == rendering.width && photograph.height == rendering.height);
  std::vector<float> map(rendering.pixels.size());
  for (std::size_t i = 0; i < map.size(); ++i)
    if (photograph.pixels[i].a >= 1.0f) map[i] = 1.0f - rendering.pixels[i].a;
  return map;
}

Image8 marked_defects(const ImageF& photograph, const ImageF& rendering) {
  const std::vector<float> holes = hole_map(photograph, rendering);
  const std::vector<float> specks = speck_map(photograph, rendering);
  ImageF marked = rendering;
  for (std::size_t i = 0; i < marked.pixels.size(); ++i) {
    const glm::vec3 dimmed = 0.4f * glm::vec3(rendering.pixels[i]);
    const glm::vec3 color = specks[i] > 0 ? glm::vec3(1, 1, 0) : dimmed;
    marked.pixels[i] = glm::vec4(glm::mix(color, glm::vec3(1, 0, 1), holes[i]), 1);
  }
  return quantised(marked);
}

}  // namespace tureen
