#include "image/box_scale.hpp"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <vector>

namespace tureen {

namespace {

/// The source pixels that an output pixel covers along one axis, with their weights.
struct Cover {
  int first = 0;
  std::vector<float> weights;  // they sum to one
};

std::vector<Cover> covers(int source, int target) {
  std::vector<Cover> result(static_cast<std::size_t>(target));
  const double step = double(source) / target;
  for (int i = 0; i < target; ++i) {
    const double begin = i * step, end = (i + 1) * step;
    Cover& cover = result[std::size_t(i)];
    cover.first = std::min(int(begin), source - 1);
    for (int p = cover.first; p < source && p < end; ++p)
      cover.weights.push_back(
          float((std::min(end, p + 1.0) - std::max(begin, double(p))) / (end - begin)));
  }
  return result;
}

/// Scales one row to the target's width: sums of colour times alpha, and of alpha, both with bytes
/// as units.
void narrow(const glm::u8vec4* row, const std::vector<Cover>& columns,
            std::vector<glm::vec4>& result) {
  for (std::size_t x = 0; x < columns.size(); ++x) {
    const glm::u8vec4* pixel = row + columns[x].first;
    glm::vec4 sum(0.0f);
    for (const float weight : columns[x].weights) {
      const float alpha = weight * float(pixel->a);
      sum += alpha * glm::vec4(pixel->r, pixel->g, pixel->b, 1.0f);
      ++pixel;
    }
    result[x] = sum;
  }
}

glm::u8vec4 to_pixel(glm::vec4 sum) {
  if (!(sum.a > 0.0f)) return glm::u8vec4(0);
  // A mean of bytes exceeds 255 only by rounding errors.
  const auto byte = [](float value) { return std::uint8_t(std::min(value, 255.0f) + 0.5f); };
  return {byte(sum.r / sum.a), byte(sum.g / sum.a), byte(sum.b / sum.a), byte(sum.a)};
}

}  // namespace

Image8 box_scaled(const Image8& image, int width, int height) {
  assert(width > 0 && height > 0 && !image.pixels.empty());
  if (width == image.width && height == image.height) return image;
  const std::vector<Cover> columns = covers(image.width, width);
  const std::vector<Cover> rows = covers(image.height, height);
  Image8 result(width, height);
  std::vector<glm::vec4> narrowed(static_cast<std::size_t>(width)), sums(narrowed.size());
  int held = -1;  // the source row in `narrowed`; two output rows may share one source row
  for (int y = 0; y < height; ++y) {
    std::fill(sums.begin(), sums.end(), glm::vec4(0.0f));
    int row = rows[std::size_t(y)].first;
    for (const float weight : rows[std::size_t(y)].weights) {
      if (row != held) narrow(&image.at(0, row), columns, narrowed);
      held = row++;
      for (std::size_t x = 0; x < sums.size(); ++x) sums[x] += weight * narrowed[x];
    }
    for (int x = 0; x < width; ++x) result.at(x, y) = to_pixel(sums[std::size_t(x)]);
  }
  return result;
}

}  // namespace tureen
