// What a lens does to a pinhole's picture, and how that is undone.
//
// The model is D. C. Brown's, "Close-range camera calibration", Photogrammetric Engineering 1971,
// with the letters that OpenCV, COLMAP and instant-ngp give it. In the camera's plane at depth 1,
// x to the right and y down, with r^2 = x^2 + y^2, the point (x, y) of the scene appears at
//   x' = x (1 + k1 r^2 + k2 r^4 + k3 r^6) + 2 p1 x y + p2 (r^2 + 2 x^2)
//   y' = y (1 + k1 r^2 + k2 r^4 + k3 r^6) + 2 p2 x y + p1 (r^2 + 2 y^2)
// and in the photograph at (fx x' + cx, fy y' + cy).
#pragma once

#include <glm/vec2.hpp>

#include "image/image.hpp"
#include "scene/camera.hpp"

namespace tureen {

struct Lens {
  double k1 = 0, k2 = 0, k3 = 0;  // radial
  double p1 = 0, p2 = 0;          // tangential

  bool operator==(const Lens&) const = default;
  bool is_pinhole() const { return *this == Lens{}; }

  /// Where the scene's point (x, y) appears.
  glm::dvec2 distorted(glm::dvec2 point) const;

  /// Whether `point` can be seen at all: on the way to it from the axis the picture must not fold
  /// back. Polynomials that were fitted to the middle of a picture do so outside of it, and what
  /// they say there is no photograph of anything.
  bool sees(glm::dvec2 point) const;
};

/// Columns and rows [left, right) x [top, bottom) of a picture.
struct PixelRectangle {
  int left = 0, top = 0, right = 0, bottom = 0;
};

struct Undistorted {
  /// As large as the photograph, and its camera's focal lengths and principal point are those of
  /// a pinhole now. Where the photograph shows nothing alpha is 0, and the colour is that of the
  /// photograph's edge nearby.
  Image8 image;
  /// Pixels that all have a source in the photograph: empty where the lens leaves less than half
  /// of the picture.
  PixelRectangle known;
};

/// Resamples a photograph, whose size is the camera's, by Catmull-Rom's cubic, colours weighted by
/// alpha. The cubic keeps the sharpness that interpolating linearly between four pixels would take
/// away. Nothing is averaged: undoing a barrel magnifies, and a pincushion shrinks by a few per
/// cent.
///
/// About 0.1 s for 1080 x 1920 on one core.
Undistorted undistorted(const Image8& photograph, const Camera& camera, const Lens& lens);

}  // namespace tureen
