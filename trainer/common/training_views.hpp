// Photographs in the form that a trainer needs: planes of bytes, without alpha.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "scene/photographs.hpp"

namespace tureen::trainer {

/// A training image. Its colours are already composited on the background.
struct TrainingView {
  Camera camera;
  /// Three planes of width x height, row 0 on top: red, green, blue; value = byte / 255.
  std::vector<std::uint8_t> target;
  /// One per pixel, 1 for ignored pixels; empty if no pixel is ignored.
  std::vector<std::uint8_t> ignored;
};

/// The photograph over a background (red, green, blue in [0, 1]), rounded to the nearest byte.
TrainingView training_view(const Photograph& photograph, std::span<const float, 3> background);

/// All photographs, in their order. Clears the images and masks in `photographs` and keeps the
/// cameras, so no image is in memory twice.
std::vector<TrainingView> take_training_views(std::vector<Photograph>& photographs,
                                              std::span<const float, 3> background);

/// The camera in coordinates relative to `origin` (world coordinates), where floats are exact
/// enough.
Camera relative_to(Camera camera, const glm::dvec3& origin);

/// The view with half the pixels along each side, means of 2 x 2; without an odd last column or
/// row. A pixel is ignored if one of the four is. For images of at least 2 x 2 pixels.
TrainingView halved(const TrainingView& view);

}  // namespace tureen::trainer
