// Photographs as a trainer takes them: planes of bytes, without alpha.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/photographs.hpp"

namespace tureen::trainer {

/// An image to learn from. Colours are composited on the background already.
struct TrainingView {
  Camera camera;
  /// Three planes of width x height, row 0 on top: red, green, blue; value = byte / 255.
  std::vector<std::uint8_t> target;
  /// One a pixel, 1 where there is nothing to learn from; empty where all pixels count.
  std::vector<std::uint8_t> ignored;
};

/// The photograph over a background (red, green, blue in [0, 1]), rounded to the nearest byte;
/// every pixel counts.
TrainingView training_view(const Photograph& photograph, std::span<const float, 3> background);

/// All of them, in their order. Takes the images: what stays in `photographs` are cameras, so
/// that no image is in memory twice.
std::vector<TrainingView> take_training_views(std::vector<Photograph>& photographs,
                                              std::span<const float, 3> background);

}  // namespace tureen::trainer
