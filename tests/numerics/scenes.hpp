// Scenes for tests of numerics, and functions to draw them with the oracle, the device and the
// trainer.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "oracle/hits.hpp"
#include "runtime/gl/context.hpp"
#include "scene/camera.hpp"
#include "scene/triangle_soup.hpp"
#include "tests/support/agreement.hpp"

namespace tureen::test {

/// The unit roundoff of floats: half the distance from 1 to the next.
inline constexpr double epsilon = 0x1p-24;

/// The distance in pixels that roundings move a vertex in the image, for an image coordinate of
/// this size. x and w of its clip position have five roundings each. Before that, the three
/// coordinates of the position minus the eye are rounded (G3).
inline double vertex_rounding(double pixels) { return (5 + 5 + std::sqrt(3.0)) * epsilon * pixels; }

/// A current context that all tests of the program share: OSMesa, desktop OpenGL with clip control.
gl::Context& shared_context();

/// Three corners per face. Each face has its own colour.
TriangleSoup soup_of(std::vector<glm::vec3> corners);

/// At the origin, looking along -z, with square pixels and the principal point in the middle.
Camera straight_camera(int width, int height, double focal);

/// The winner of each pixel, row 0 on top, no_face for the background. Use `snapped` to compare
/// with the device, `exact` to compare with the trainer.
std::vector<std::uint32_t> faces_of_oracle(const TriangleSoup& soup, const Camera& camera,
                                           oracle::Coverage coverage = oracle::Coverage::snapped);
std::vector<std::uint32_t> faces_of_device(const TriangleSoup& soup, const Camera& camera,
                                           bool reversed_depth = true);
/// Opaque, like the faces in training. `near` and `far` are those in the trainer's configuration.
std::vector<std::uint32_t> faces_of_trainer(const TriangleSoup& soup, const Camera& camera,
                                            double near = 0.01, double far = 100);

/// How many pixels show a face.
double shown_pixels(const std::vector<std::uint32_t>& faces);

/// How many pixels name different faces.
double differing(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b);

/// As differing(), without pixels at an edge in `reference`. Where all eight neighbours show the
/// same face, a rounding cannot have moved an edge across the centre.
double differing_away_from_edges(const std::vector<std::uint32_t>& reference,
                                 const std::vector<std::uint32_t>& other, int width, int height);

/// Upper bound of the count of independent events with this mean. The count exceeds it with a
/// probability of 1 in 16,000, as a normal deviate exceeds four standard deviations.
double most_of(double mean);

/// The corners of a face in homogeneous pixels: (x w, y w, w), rows from the top, w the depth.
std::array<glm::dvec3, 3> homogeneous_corners(const TriangleSoup& soup, const glm::dvec3& origin,
                                              const Camera& camera, std::uint32_t face);

/// The difference from the oracle's colours, where both show the same face.
struct ColorError {
  /// A channel's error beyond half a step of 8 bits, and its allowed error, at the pixel where the
  /// first is largest relative to the second. Without an error beyond half a step: 0, and the
  /// rounding of colours.
  double beyond = 0, allowed = 0;
  double compared = 0;  // fraction of pixels where both show the same face
};

/// The allowed error of a channel is its change when roundings move the pixel's barycentrics:
/// roundings of transformed corners (vertex_rounding), of the interpolation, and of the visibility
/// buffer.
ColorError color_error(const TriangleSoup& soup, const glm::dvec3& origin, const Camera& camera,
                       const OracleImage& expected, const Drawn& drawn);

}  // namespace tureen::test
