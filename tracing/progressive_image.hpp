// An image by rays for programs that show it while it is drawn: coarse, then sharp tile by tile,
// then with more samples per pixel.
#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "image/image.hpp"
#include "scene/camera.hpp"
#include "tracing/traced_images.hpp"

namespace tureen::tracing {

/// Pixels to a side of the squares that the coarse image has one ray for: the fewest of 1, 2, 4, 8
/// and 16 with which `pixels` of the sharp image take at most `seconds` by this speed.
/// `seconds_per_pixel` 0: not known; the result is 16.
int coarse_square(double pixels, double seconds_per_pixel, double seconds);

class ProgressiveImage {
 public:
  /// The image of TracedImages with `samples` jittered samples. After more than max_seconds of
  /// drawing, the sharp image gets no further sample.
  ProgressiveImage(Camera camera, int samples, double max_seconds);

  /// Draws the next of these, and measures `seconds_per_pixel`; 0: not known:
  /// - the coarse image, enlarged; without a known speed, a coarser one before it
  /// - a tile with one ray per pixel, from the middle outwards; all at once if that takes less than
  ///   half a second
  /// - a further sample of all pixels
  /// If the progress of `images` throws, the image stays as it is.
  void step(TracedImages& images, double& seconds_per_pixel);
  bool is_complete() const;

  /// Over the background of the images, opaque; black before the first step.
  const Image8& image() const { return shown_; }
  /// Complete samples of all pixels; 0 before the image is sharp.
  int samples() const { return samples_; }
  /// The part of the pixels that are sharp, 0..1.
  double sharp() const;

 private:
  struct Tile {
    glm::ivec2 corner, size;
  };
  void draw_coarse(TracedImages& images, int square);
  void draw_tile(TracedImages& images, const Tile& tile, int sample);
  /// The whole image, or squares of pixels sorted by their distance from its middle.
  std::vector<Tile> tiles(double seconds_per_pixel) const;

  Camera camera_;
  int wanted_;
  double max_seconds_, seconds_ = 0;
  int square_ = 0;  // of the coarse image; 0: none yet
  std::vector<Tile> tiles_;
  std::size_t next_tile_ = 0;
  int samples_ = 0;
  std::vector<glm::dvec4> sums_;
  Image8 shown_;
};

}  // namespace tureen::tracing
