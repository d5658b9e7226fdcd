// The image held against the photograph of the camera that it is drawn from: side by side, as a
// map of differences, and in numbers.
#pragma once

#include <optional>

#include "image/image.hpp"
#include "image/metrics.hpp"
#include "scene/camera.hpp"
#include "viewer/texture.hpp"

namespace tureen::viewer {

/// Where a photograph lies in the window, in points: its corners may lie outside.
struct PlacedPhotograph {
  glm::dvec2 low{0.0}, high{0.0};
};

/// The place at which each ray of the photograph's camera meets the same ray of the view's, which
/// has the same pose: both are pinholes, so it is a rectangle. `points_per_pixel` is the window's.
PlacedPhotograph place(const Camera& photograph, const Camera& view, double points_per_pixel);

struct Comparison {
  enum class Show { off, split, photograph, difference };
  Show show = Show::off;
  double divider = 0.5;  // of the image's width; left of it is the photograph

  int photograph = -1;  // the index of the one that `texture` shows
  ImageTexture texture;

  /// Of the scene as it is drawn now against that photograph, at the photograph's size.
  struct Result {
    Metrics metrics;
    ImageTexture difference;
  };
  std::optional<Result> result;
  bool asked = false;  // a result is being made
  int ticket = 0;      // grows when what was asked for is no longer wanted

  void forget() {
    result.reset();
    asked = false;
    ++ticket;
  }
};

}  // namespace tureen::viewer
