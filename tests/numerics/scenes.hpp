// What tests of numerics draw, and who draws it: the oracle, the device, the trainer.
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

/// How far roundings move a vertex in the image, in pixels, of an image coordinate of that size:
/// x and w of its clip position are five roundings each, and the three coordinates of what it is
/// less the eye are rounded before (G3).
inline double vertex_rounding(double pixels) { return (5 + 5 + std::sqrt(3.0)) * epsilon * pixels; }

/// One for all tests of the program, current: OSMesa, desktop OpenGL with clip control.
gl::Context& shared_context();

/// Three corners a face; faces have colours of their own.
TriangleSoup soup_of(std::vector<glm::vec3> corners);

/// At the origin, looking along -z, with square pixels and the principal point in the middle.
Camera straight_camera(int width, int height, double focal);

/// The winner of each pixel, row 0 on top, no_face for none.
/// Snapped to the device's grid, to be held against the device; exact, against the trainer.
std::vector<std::uint32_t> faces_of_oracle(const TriangleSoup& soup, const Camera& camera,
                                           oracle::Coverage coverage = oracle::Coverage::snapped);
std::vector<std::uint32_t> faces_of_device(const TriangleSoup& soup, const Camera& camera,
                                           bool reversed_depth = true);
/// Opaque, as training sees faces; `near` and `far` are the configuration's.
std::vector<std::uint32_t> faces_of_trainer(const TriangleSoup& soup, const Camera& camera,
                                            double near = 0.01, double far = 100);

/// How many pixels show a face.
double shown_pixels(const std::vector<std::uint32_t>& faces);

/// How many pixels name different faces.
double differing(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b);

/// Of those, the ones that do not lie at an edge of `reference`: where all eight neighbours show
/// the same face there, a rounding cannot have moved an edge across the centre.
double differing_away_from_edges(const std::vector<std::uint32_t>& reference,
                                 const std::vector<std::uint32_t>& other, int width, int height);

/// Of things that happen independently of each other and so many times in the mean: how often at
/// most, but once in 16,000, as a normal deviate is beyond four standard deviations.
double most_of(double mean);

/// The corners of a face in homogeneous pixels: (x w, y w, w), rows from the top, w the depth.
std::array<glm::dvec3, 3> homogeneous_corners(const TriangleSoup& soup, const glm::dvec3& origin,
                                              const Camera& camera, std::uint32_t face);

/// How colours are held against the oracle's, where both show the same face.
struct ColorError {
  /// What a channel is off beyond half a step of 8 bits, and what it may be, of the pixel where the
  /// one is nearest to the other; where no channel is off by more, none and what colours are
  /// rounded by.
  double beyond = 0, allowed = 0;
  double compared = 0;  // fraction of pixels where both show the same face
};

/// What a channel may be off is what it changes by where the pixel's barycentrics are moved by
/// their roundings: those of corners on their way (vertex_rounding), of the interpolation, and of
/// the visibility buffer.
ColorError color_error(const TriangleSoup& soup, const glm::dvec3& origin, const Camera& camera,
                       const OracleImage& expected, const Drawn& drawn);

}  // namespace tureen::test
