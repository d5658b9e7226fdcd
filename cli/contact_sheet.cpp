#include "cli/contact_sheet.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/vec4.hpp>
#include <vector>

namespace tureen::cli {

namespace {

constexpr int margin = 8;  // pixels between thumbnails and around the sheet

/// Which source pixels an output pixel covers along one axis, and how much of each.
struct Cover {
  int first = 0;
  std::vector<double> weights;
};

std::vector<Cover> covers(int source, int target) {
  std::vector<Cover> result(static_cast<std::size_t>(target));
  const double step = double(source) / target;
  for (int i = 0; i < target; ++i) {
    const double begin = i * step, end = (i + 1) * step;
    Cover& cover = result[std::size_t(i)];
    cover.first = std::min(int(begin), source - 1);
    for (int p = cover.first; p < source && p < end; ++p)
      cover.weights.push_back(std::min(end, p + 1.0) - std::max(begin, double(p)));
  }
  return result;
}

}  // namespace

Image8 box_scaled(const Image8& image, int width, int height) {
  assert(width > 0 && height > 0 && !image.pixels.empty());
  const std::vector<Cover> columns = covers(image.width, width);
  const std::vector<Cover> rows = covers(image.height, height);
  Image8 result(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Cover &row = rows[std::size_t(y)], &column = columns[std::size_t(x)];
      glm::dvec3 color(0);  // times alpha
      double alpha = 0, area = 0;
      for (std::size_t j = 0; j < row.weights.size(); ++j)
        for (std::size_t i = 0; i < column.weights.size(); ++i) {
          const double weight = row.weights[j] * column.weights[i];
          const glm::u8vec4& p = image.at(column.first + int(i), row.first + int(j));
          color += weight * p.a * glm::dvec3(p);
          alpha += weight * p.a;
          area += weight;
        }
      if (alpha > 0) color /= alpha;
      result.at(x, y) = glm::u8vec4(glm::dvec4(color, alpha / area) + 0.5);
    }
  return result;
}

Image8 thumbnail(const Image8& image, int cell) {
  const double scale = std::min(1.0, double(cell) / std::max(image.width, image.height));
  const auto side = [&](int s) { return std::max(1, int(std::lround(s * scale))); };
  return box_scaled(image, side(image.width), side(image.height));
}

Image8 contact_sheet(std::span<const Image8> pictures, int cell) {
  std::vector<Image8> thumbnails;
  int width = 1, height = 1;
  for (const Image8& picture : pictures) {
    thumbnails.push_back(thumbnail(picture, cell));
    width = std::max(width, thumbnails.back().width);
    height = std::max(height, thumbnails.back().height);
  }
  const int count = std::max(1, int(pictures.size()));
  const int columns =
      std::clamp(int(std::lround(std::sqrt(double(count) * height / width))), 1, count);
  const int rows = (count + columns - 1) / columns;
  Image8 sheet(columns * (width + margin) + margin, rows * (height + margin) + margin);
  for (int i = 0; i < int(thumbnails.size()); ++i) {
    const Image8& small = thumbnails[std::size_t(i)];
    const int left = margin + (i % columns) * (width + margin) + (width - small.width) / 2;
    const int top = margin + (i / columns) * (height + margin) + (height - small.height) / 2;
    for (int y = 0; y < small.height; ++y)
      for (int x = 0; x < small.width; ++x) sheet.at(left + x, top + y) = small.at(x, y);
  }
  return sheet;
}

}  // namespace tureen::cli
