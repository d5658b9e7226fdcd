#include "tracing/progressive_image.hpp"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "base/steady_seconds.hpp"

namespace tureen::tracing {

namespace {

/// The coarse image, with all that precedes it, is to appear within half a second.
constexpr double coarse_seconds = 0.25;
/// An image that takes less is drawn without tiles.
constexpr double whole_seconds = 0.5;
/// Pixels to a side of a tile. For each, all splats are projected: fewer pixels would cost more
/// than their rays.
constexpr int tile_side = 128;

/// Linear between the centres of the pixels.
Image8 enlarged(const ImageF& small, int width, int height) {
  const glm::vec2 from(small.width, small.height), to(width, height);
  ImageF large(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const glm::vec2 at = (glm::vec2(x, y) + 0.5f) * from / to - 0.5f;
      const glm::vec2 within = glm::clamp(at, glm::vec2(0.0f), from - 1.0f);
      const glm::ivec2 low(within), high = glm::min(low + 1, glm::ivec2(from) - 1);
      const auto row = [&](int i) {
        return glm::mix(small.at(low.x, i), small.at(high.x, i), within.x - float(low.x));
      };
      large.at(x, y) = glm::mix(row(low.y), row(high.y), within.y - float(low.y));
    }
  return quantised(large);
}

}  // namespace

int coarse_square(double pixels, double seconds_per_pixel, double seconds) {
  constexpr int coarsest = 16;
  int side = 1;
  while (side < coarsest &&
         (seconds_per_pixel <= 0 || pixels / (side * side) * seconds_per_pixel > seconds))
    side *= 2;
  return side;
}

ProgressiveImage::ProgressiveImage(Camera camera, int samples, double max_seconds)
    : camera_(std::move(camera)),
      wanted_(samples),
      max_seconds_(max_seconds),
      sums_(std::size_t(camera_.width) * std::size_t(camera_.height)),
      shown_(camera_.width, camera_.height, glm::u8vec4(0, 0, 0, 255)) {}

bool ProgressiveImage::is_complete() const {
  return samples_ >= wanted_ || (samples_ > 0 && seconds_ > max_seconds_);
}

double ProgressiveImage::sharp() const {
  return tiles_.empty() ? 0 : double(next_tile_) / double(tiles_.size());
}

std::vector<ProgressiveImage::Tile> ProgressiveImage::tiles(double seconds_per_pixel) const {
  const glm::ivec2 size(camera_.width, camera_.height);
  if (seconds_per_pixel * double(sums_.size()) <= whole_seconds) return {{{0, 0}, size}};
  std::vector<Tile> result;
  for (int y = 0; y < size.y; y += tile_side)
    for (int x = 0; x < size.x; x += tile_side)
      result.push_back({{x, y}, glm::min(glm::ivec2(tile_side), size - glm::ivec2(x, y))});
  const auto from_middle = [&](const Tile& tile) {
    return glm::length(glm::dvec2(tile.corner) + 0.5 * glm::dvec2(tile.size) -
                       0.5 * glm::dvec2(size));
  };
  std::stable_sort(result.begin(), result.end(),
                   [&](const Tile& a, const Tile& b) { return from_middle(a) < from_middle(b); });
  return result;
}

void ProgressiveImage::draw_coarse(TracedImages& images, int square) {
  const auto part = [&](int side) { return (side + square - 1) / square; };
  const Camera camera = resampled(camera_, part(camera_.width), part(camera_.height));
  const std::vector<glm::dvec4> sums = images.sample({.camera = camera}, 0);
  ImageF small(camera.width, camera.height);
  for (std::size_t i = 0; i < sums.size(); ++i)
    small.pixels[i] = glm::vec4(glm::vec3(images.mean(sums[i], 1)), 1.0f);
  shown_ = enlarged(small, camera_.width, camera_.height);
  square_ = square;
}

void ProgressiveImage::draw_tile(TracedImages& images, const Tile& tile, int sample) {
  Camera camera = camera_;
  camera.width = tile.size.x;
  camera.height = tile.size.y;
  camera.cx -= tile.corner.x;
  camera.cy -= tile.corner.y;
  const std::vector<glm::dvec4> own = images.sample({.camera = camera, .whole = camera_}, sample);
  ImageF row(tile.size.x, 1);
  for (int y = 0; y < tile.size.y; ++y) {
    const std::size_t first =
        std::size_t(tile.corner.y + y) * std::size_t(camera_.width) + std::size_t(tile.corner.x);
    for (std::size_t x = 0; x < row.pixels.size(); ++x) {
      sums_[first + x] += own[std::size_t(y) * row.pixels.size() + x];
      row.pixels[x] = glm::vec4(glm::vec3(images.mean(sums_[first + x], sample + 1)), 1.0f);
    }
    const Image8 bytes = quantised(row);
    std::copy(bytes.pixels.begin(), bytes.pixels.end(),
              shown_.pixels.begin() + std::ptrdiff_t(first));
  }
}

void ProgressiveImage::step(TracedImages& images, double& seconds_per_pixel) {
  if (is_complete()) return;
  const double began = steady_seconds();
  double pixels = double(sums_.size());
  const int square = coarse_square(pixels, seconds_per_pixel, coarse_seconds);
  if (tiles_.empty() && square > 1 && (square_ == 0 || 2 * square <= square_)) {
    draw_coarse(images, square);
    pixels /= square * square;
  } else if (samples_ == 0) {
    if (tiles_.empty()) tiles_ = tiles(seconds_per_pixel);
    const Tile& tile = tiles_[next_tile_];
    draw_tile(images, tile, 0);
    pixels = double(tile.size.x) * tile.size.y;
    if (++next_tile_ == tiles_.size()) samples_ = 1;
  } else {
    draw_tile(images, {{0, 0}, {camera_.width, camera_.height}}, samples_);
    ++samples_;
  }
  const double seconds = steady_seconds() - began;
  seconds_ += seconds;
  seconds_per_pixel = seconds / pixels;
}

}  // namespace tureen::tracing
