#include "trainer/common/plain_background.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <vector>

namespace tureen::trainer {

namespace {

/// The object may cross the border of some photographs. The walls and skies of places do not fill
/// the borders of all.
constexpr double plain_part = 0.95;
/// In steps of a byte: compression and uneven light.
constexpr int tolerance = 8;

template <class Visit>
void for_each_border_pixel(const Image8& image, const Visit& visit) {
  for (int y = 0; y < image.height; ++y) {
    const bool whole_row = y == 0 || y == image.height - 1;
    for (int x = 0; x < image.width; x += whole_row ? 1 : std::max(image.width - 1, 1))
      visit(image.at(x, y));
  }
}

}  // namespace

std::optional<glm::vec3> plain_background(const Dataset& dataset) {
  std::vector<glm::u8vec4> border;
  for (const Photograph& photograph : dataset.train)
    for_each_border_pixel(photograph.image(),
                          [&](const glm::u8vec4& pixel) { border.push_back(pixel); });
  if (border.empty()) return std::nullopt;
  // The median of each channel, by its histogram.
  std::array<int, 3> median{};
  for (int c = 0; c < 3; ++c) {
    std::array<std::size_t, 256> counts{};
    for (const glm::u8vec4& pixel : border) ++counts[pixel[c]];
    int& value = median[std::size_t(c)];
    for (std::size_t below = 0; 2 * (below += counts[std::size_t(value)]) < border.size();) ++value;
  }
  const auto plain = std::ranges::count_if(border, [&](const glm::u8vec4& pixel) {
    bool near = true;
    for (int c = 0; c < 3; ++c)
      near = near && std::abs(int(pixel[c]) - median[std::size_t(c)]) <= tolerance;
    return near;
  });
  if (double(plain) < plain_part * double(border.size())) return std::nullopt;
  return glm::vec3(median[0], median[1], median[2]) / 255.0f;
}

}  // namespace tureen::trainer
