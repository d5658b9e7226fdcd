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
  // The median of each channel, by its histogram.
  std::array<std::array<std::size_t, 256>, 3> counts{};
  std::size_t pixels = 0;
  for (const Photograph& photograph : dataset.train)
    for_each_border_pixel(photograph.image, [&](const glm::u8vec4& pixel) {
      for (std::size_t c = 0; c < 3; ++c) ++counts[c][pixel[int(c)]];
      ++pixels;
    });
  if (pixels == 0) return std::nullopt;
  std::array<int, 3> median{};
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t below = 0; 2 * (below += counts[c][std::size_t(median[c])]) < pixels;)
      ++median[c];
  std::size_t plain = 0;
  for (const Photograph& photograph : dataset.train)
    for_each_border_pixel(photograph.image, [&](const glm::u8vec4& pixel) {
      bool near = true;
      for (std::size_t c = 0; c < 3; ++c)
        near = near && std::abs(int(pixel[int(c)]) - median[c]) <= tolerance;
      plain += near ? 1 : 0;
    });
  if (double(plain) < plain_part * double(pixels)) return std::nullopt;
  return glm::vec3(median[0], median[1], median[2]) / 255.0f;
}

}  // namespace tureen::trainer
