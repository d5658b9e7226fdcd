// Rays, and what they meet.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <vector>

namespace tureen::tracing {

/// A face of a soup, as a ray leaves it.
struct FaceOfLayer {
  static constexpr std::uint32_t none = 0xffffffffu;
  std::uint32_t layer = none;  // index in Scene::layers
  std::uint32_t face = 0;

  bool operator==(const FaceOfLayer&) const = default;
};

/// A ray in world coordinates. A pixel's ray is a cone: at the length s of the whole path from the
/// eye, its width is `pixel` s.
struct Ray {
  glm::dvec3 origin{0};
  glm::dvec3 direction{0, 0, -1};  // of unit length
  double path = 0;                 // length of the path from the eye to `origin`
  double pixel = 0;                // width of a pixel at distance 1
  FaceOfLayer from = {};           // does not meet this face
};

/// The same ray in the coordinates and units of a layer, as vectors of floats read it.
struct RayInLayer {
  glm::dvec3 origin, direction;  // of unit length
  /// The eye before all reflections and refractions: back from the origin by the whole path.
  /// Colours are functions of the direction from it. A plane mirror thus shows the mirrored scene.
  glm::dvec3 eye;
  float high[3], low[3];       // their sum is the origin: differences from it keep their digits
  float along[3], inverse[3];  // the direction, and one over it, finite
  float scale;                 // world units per layer unit
  float path, pixel;
  /// Boxes grow by grow + grow_by_distance * (distance to their farthest point): by the footprint
  /// of the pixel there, and by the rounding of their distances.
  float grow, grow_by_distance;
  float end;     // length of the ray up to an opaque surface; infinity without one
  double least;  // below this distance, a face is where the ray starts, up to rounding
};

/// A splat on a ray.
struct SplatOnRay {
  /// The order along the ray: the bits of the distance from the origin, in world units, as a float
  /// >= 0, above the place of the splat in the order of layers and indices.
  std::uint64_t key;
  float alpha;         // limited by the profile
  std::uint32_t lane;  // its place in the blocks of its layer

  std::uint32_t place() const { return std::uint32_t(key); }
};

/// The point at which a ray meets a soup.
struct SurfaceOnRay {
  FaceOfLayer face = {};
  double b0 = 0, b1 = 0;  // weights of the face's vertices 0 and 1
  double distance = std::numeric_limits<double>::infinity();  // in world units

  bool exists() const { return face.layer != FaceOfLayer::none; }
};

}  // namespace tureen::tracing
