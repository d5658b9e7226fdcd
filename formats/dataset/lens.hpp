// Lens distortion of a photograph, and its removal.
//
// The model LensModel::brown is D. C. Brown's, "Close-range camera calibration", Photogrammetric
// Engineering 1971, with the letters of OpenCV, COLMAP and instant-ngp. Let (x, y) be a scene point
// in the camera's plane at depth 1, x to the right and y down, and r^2 = x^2 + y^2. It appears at
//   x' = x (1 + k1 r^2 + k2 r^4 + k3 r^6) + 2 p1 x y + p2 (r^2 + 2 x^2)
//   y' = y (1 + k1 r^2 + k2 r^4 + k3 r^6) + 2 p2 x y + p1 (r^2 + 2 y^2)
// and in the photograph at (fx x' + cx, fy y' + cy).
//
// The model LensModel::fisheye is J. Kannala and S. S. Brandt's, "A generic camera model and
// calibration method for conventional, wide-angle, and fish-eye lenses", PAMI 2006, as OpenCV and
// COLMAP's OPENCV_FISHEYE have it. With the angle theta = atan(r) from the axis, in radians,
//   (x', y') = (x, y) theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8) / r
// Points beside or behind the camera, at 90 degrees or more, have no (x, y).
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

#include "image/image.hpp"
#include "scene/camera.hpp"

namespace tureen {

enum class LensModel { brown, fisheye };

struct Lens {
  LensModel model = LensModel::brown;
  double k1 = 0, k2 = 0, k3 = 0;  // radial
  double k4 = 0;                  // radial, of fisheye; brown ignores it
  double p1 = 0, p2 = 0;          // tangential, of brown; fisheye ignores them

  bool operator==(const Lens&) const = default;
  /// False for every fisheye.
  bool is_pinhole() const { return *this == Lens{}; }

  /// The image position of the scene point (x, y).
  glm::dvec2 distorted(glm::dvec2 point) const;

  /// Whether `point` is visible: the mapping from the axis to it must not fold back. Polynomials
  /// fitted to the middle of an image fold outside of it, where they are meaningless.
  bool sees(glm::dvec2 point) const;
};

/// Columns and rows [left, right) x [top, bottom) of an image.
struct PixelRectangle {
  int left = 0, top = 0, right = 0, bottom = 0;
};

struct Undistorted {
  /// As large as the photograph; focal lengths and principal point of its camera are now those of a
  /// pinhole. Pixels without a source have alpha 0 and the colour of the nearby edge of the
  /// photograph.
  Image8 image;
  /// A rectangle of pixels that all have a source in the photograph; empty if the lens leaves less
  /// than half of the image.
  PixelRectangle known;
};

/// Resamples a photograph, whose size is the camera's, by Catmull-Rom's cubic, weighted by alpha.
/// The cubic preserves sharpness that bilinear interpolation would lose. There is no area
/// averaging: undoing barrel distortion magnifies, and undoing pincushion distortion shrinks by
/// only a few per cent.
///
/// A fisheye's image is cropped by this: a pinhole with the same focal lengths, which keep the
/// detail at the axis, sees 2 atan(w / 2 fx) of it, always less than 180 degrees.
///
/// Time: about 0.1 s for 1080 x 1920 on one core.
Undistorted undistorted(const Image8& photograph, const Camera& camera, const Lens& lens);

/// Which pixels of undistorted() depend on a pixel of the photograph where `marked` is 1: 1 for
/// each such pixel, 0 for the others. `marked` has one value per pixel.
std::vector<std::uint8_t> undistorted_marks(const std::vector<std::uint8_t>& marked,
                                            const Camera& camera, const Lens& lens);

}  // namespace tureen
