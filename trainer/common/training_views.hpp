// Photographs in the form that a trainer needs: planes of bytes, without alpha.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
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
  /// Pixels in a file, from which loaded() reads the two above.
  struct Stored {
    StoredBytes planes, ignored;           // planes: as of StoredImage
    std::array<float, 3> background = {};  // behind planes with alpha
  };
  std::optional<Stored> stored = {};
};

/// The view with its pixels in memory. Throws InputError if the file cannot be read.
TrainingView loaded(const TrainingView& view);
/// Whether the view, in memory or stored, has ignored pixels.
bool has_ignored(const TrainingView& view);
/// Moves the pixels to the file.
void store(TrainingView& view, const std::shared_ptr<ScratchFile>& file);
/// Lets the system read the pixels of a stored view ahead.
void expect(const TrainingView& view);

/// The photograph over a background (red, green, blue in [0, 1]), rounded to the nearest byte, in
/// memory.
TrainingView training_view(const Photograph& photograph, std::span<const float, 3> background);

/// All photographs, in their order; stored, where the photograph is. Clears the images and masks in
/// `photographs` and keeps the cameras, so no image is in memory twice.
std::vector<TrainingView> take_training_views(std::vector<Photograph>& photographs,
                                              std::span<const float, 3> background);

/// The camera in coordinates relative to `origin` (world coordinates), where floats are exact
/// enough.
Camera relative_to(Camera camera, const glm::dvec3& origin);

/// The view with half the pixels along each side, means of 2 x 2; without an odd last column or
/// row. A pixel is ignored if one of the four is. For images of at least 2 x 2 pixels.
TrainingView halved(const TrainingView& view);
/// The view, halved until it has at most `max_pixels` or a side would be shorter than `min_side`,
/// at least 1.
TrainingView halved_to(TrainingView view, std::int64_t max_pixels, int min_side);

}  // namespace tureen::trainer
