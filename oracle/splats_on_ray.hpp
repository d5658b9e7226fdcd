// Splats on rays of any origin, in double precision and without a tree: every splat whose bounding
// sphere the ray meets. The reference for tracing/, whose mathematics it does not share.
//
// Alpha along a ray with direction d, at the length s of its whole path:
//   Gaussians by EWA   exp(-q / 2) of the Gaussian projected along d onto the plane across it,
//   whose
//                      variances are widened by the profile's low pass times the squared width of
//                      the pixel at the centre. The distance is that of its mean on the ray.
//   discs              on their plane; with LowPass::screen at least a Gaussian of that variance
//                      across the ray, at the distance of the centre
//   windows            opacity (distance from the nearest edge / inradius)^sigma in their own plane
//   neural densities   the integral over the chord from the ray's origin to the opaque surface
// Order: the distance of the mean, of the plane, of the middle of the chord. Only splats at a
// distance above 0 and before the opaque surface exist.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <vector>

#include "scene/splats.hpp"

namespace tureen::oracle {

/// Colours are functions of the direction from the eye of the ray: back from its origin by the
/// path.
inline glm::dvec3 eye_of(const auto& ray) { return ray.origin - ray.path * ray.direction; }

/// In any coordinates. A pixel's ray has the width `pixel` times the length of its path.
struct LightRay {
  glm::dvec3 origin{0}, direction{0, 0, -1};  // of unit length
  double path = 0;                            // from the eye to the origin
  double pixel = 0;
};

struct SplatOnRay {
  double distance = std::numeric_limits<double>::infinity();
  double alpha = 0;  // by limited_alpha()
  glm::dvec3 color{0};
};

/// The splats of one layer, in its coordinates.
class SplatsOnRays {
 public:
  /// `splats` outlives the object.
  explicit SplatsOnRays(const Splats& splats);

  struct Found {
    SplatOnRay splat;
    std::size_t index;
  };
  /// Those on the ray before `end`, in the order of their indices. Distances are in layer units.
  void find(const LightRay& ray, double end, std::vector<Found>& found) const;

 private:
  struct Sphere {
    glm::dvec3 center;
    double radius;
  };
  SplatOnRay on_ray(std::size_t i, const LightRay& ray, double end) const;

  const Splats& splats_;
  std::vector<Sphere> spheres_;  // of each splat: around all points where alpha is above 0
  double widening_ = 0;          // of the spheres, in widths of the pixel
};

}  // namespace tureen::oracle
