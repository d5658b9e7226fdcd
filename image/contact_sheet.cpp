#include "image/contact_sheet.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "image/box_scale.hpp"

namespace tureen {

namespace {

constexpr int margin = 8;  // pixels between thumbnails and around the sheet

}  // namespace

Image8 thumbnail(const Image8& image, int cell) {
  const double scale = std::min(1.0, double(cell) / std::max(image.width, image.height));
  const auto side = [&](int s) { return std::max(1, int(std::lround(s * scale))); };
  return box_scaled(image, side(image.width), side(image.height));
}

Image8 contact_sheet(std::span<const Image8> images, int cell) {
  std::vector<Image8> thumbnails;
  int width = 1, height = 1;
  for (const Image8& image : images) {
    thumbnails.push_back(thumbnail(image, cell));
    width = std::max(width, thumbnails.back().width);
    height = std::max(height, thumbnails.back().height);
  }
  const int count = std::max(1, int(images.size()));
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

}  // namespace tureen
