// The comparison of the image with the photograph of the same camera: split, as a map of
// differences, and as metrics.
#pragma once

#include <optional>

#include "image/image.hpp"
#include "image/metrics.hpp"
#include "scene/camera.hpp"
#include "viewer/gui/texture.hpp"

namespace tureen::viewer {

/// The rectangle of a photograph in the window, in points. Its corners may lie outside.
struct PlacedPhotograph {
  glm::dvec2 low{0.0}, high{0.0};
};

/// The rectangle in which the rays of the photograph's camera match those of the view. Both cameras
/// are pinholes with the same pose. `points_per_pixel`: of the window.
inline PlacedPhotograph place(const Camera& photograph, const Camera& view,
                              double points_per_pixel) {
  const auto at = [&](double u, double v) {
    return points_per_pixel * glm::dvec2(view.cx + view.fx * (u - photograph.cx) / photograph.fx,
                                         view.cy + view.fy * (v - photograph.cy) / photograph.fy);
  };
  return {at(0, 0), at(photograph.width, photograph.height)};
}

struct Comparison {
  enum class Show { off, split, photograph, difference };
  Show show = Show::off;
  double divider = 0.5;  // fraction of the image's width; the photograph is on its left

  int photograph = -1;  // index of the one in `texture`; -1: none
  ImageTexture texture;

  /// The current rendering compared with that photograph, at the photograph's size.
  struct Result {
    Metrics metrics;
    ImageTexture difference;
  };
  std::optional<Result> result;
  bool asked = false;  // a result is being computed
  int ticket = 0;      // incremented when the requested result becomes obsolete

  void forget() {
    result.reset();
    asked = false;
    ++ticket;
  }
};

}  // namespace tureen::viewer
