// Lens distortion of a photograph, and its removal.
//
// With a scene point (x, y) in the camera's plane at depth 1, x to the right and y down, and
// r^2 = x^2 + y^2, a model gives the place (x', y') of the point, which lies in the photograph at
// (fx x' + cx, fy y' + cy). A fisheye's models begin with the angle theta = atan(r) from the axis,
// in radians: (x, y) = theta (x, y) / r. Points at 90 degrees or more from the axis have no (x, y).
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "image/image.hpp"
#include "scene/camera.hpp"

namespace tureen {

/// A formula of distortion. Its coefficients have COLMAP's order.
struct LensModel {
  std::string_view name;
  std::size_t coefficients;
  glm::dvec2 (*distorted)(std::span<const double> coefficients, glm::dvec2 point);
  bool is_fisheye = false;
};

/// D. C. Brown, "Close-range camera calibration", Photogrammetric Engineering 1971, with the
/// denominator of OpenCV: k1, k2, p1, p2, k3, k4, k5, k6.
///   x' = x (1 + k1 r^2 + k2 r^4 + k3 r^6) / (1 + k4 r^2 + k5 r^4 + k6 r^6)
///        + 2 p1 x y + p2 (r^2 + 2 x^2)
///   y' = the same with x and y, p1 and p2 exchanged
extern const LensModel brown_model;
/// J. Kannala and S. S. Brandt, "A generic camera model and calibration method for conventional,
/// wide-angle, and fish-eye lenses", PAMI 2006: k1, k2, k3, k4 of theta^2, theta^4 and so on.
extern const LensModel fisheye_model;
/// F. Devernay and O. Faugeras, "Straight lines have to be straight", 2001: r' = atan(2 r tan(omega
/// / 2)) / omega.
extern const LensModel fov_model;
/// A fisheye with J. Weng's thin prism (PAMI 1992): k1, k2, p1, p2, k3, k4, sx1, sy1.
extern const LensModel thin_prism_model;
/// Project Aria's Fisheye624: k0 to k5, p0, p1, s0 to s3.
extern const LensModel rad_tan_thin_prism_model;
/// A. Fitzgibbon, "Simultaneous linear estimation of multiple view geometry and lens distortion",
/// 2001: r = r' / (1 + k r'^2).
extern const LensModel division_model;
/// B. Khomutenko and others, "An enhanced unified camera model", 2016, with alpha and beta:
/// (x', y') = (x, y) / (alpha sqrt(beta r^2 + 1) + 1 - alpha).
extern const LensModel eucm_model;

struct Lens {
  const LensModel* model = nullptr;  // null: a pinhole
  std::array<double, 12> coefficients{};

  bool operator==(const Lens&) const = default;
  bool is_pinhole() const { return !model; }
  bool is_fisheye() const { return model && model->is_fisheye; }

  /// The place of the scene point (x, y) in the image.
  glm::dvec2 distorted(glm::dvec2 point) const;

  /// Whether `point` is visible: the mapping from the axis to it must not fold back. Polynomials
  /// fitted to the middle of an image fold outside of it, where they are meaningless.
  bool sees(glm::dvec2 point) const;
};

/// A lens of the model; a pinhole if its coefficients make it one.
Lens lens_of(const LensModel& model, std::span<const double> coefficients);

/// Numbers of brown_model, by name, or the first four of fisheye_model.
struct LensNumbers {
  double k1 = 0, k2 = 0, k3 = 0, k4 = 0, k5 = 0, k6 = 0, p1 = 0, p2 = 0;

  bool operator==(const LensNumbers&) const = default;
};
Lens brown(const LensNumbers& numbers);
Lens fisheye(const LensNumbers& numbers);

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
