// What rays need from a kind of primitives. Each kernel is one such object in a file; the list is
// in ray_kernels.cpp.
//
// Kernels of splats give alpha along a ray of any origin, off the image:
//   Gaussians            by their largest density on the ray, with the profile's dilation at the
//                        width of the pixel there
//   discs                on their plane, with the profile's low pass on the screen likewise
//   triangle windows     in their own plane
//   neural densities     by their chord, from the origin of the ray to the opaque surface
// Which splat is in front depends on the distance of that point: of the largest density, of the
// plane, or of the middle of the chord.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "scene/scene.hpp"
#include "tracing/bvh/bvh.hpp"
#include "tracing/ray.hpp"

namespace tureen::tracing {

class TracedLayer;

/// Adds the splats on the ray at distances in [from, to), in world units.
using CollectSplats = void(const TracedLayer& layer, const RayInLayer& ray, float from, float to,
                           std::vector<SplatOnRay>& hits);

struct RayKernel {
  /// Whether it treats these primitives.
  bool (*draws)(const Primitives& primitives);
  std::size_t (*count)(const Primitives& primitives);
  /// The numbers of a primitive in its block.
  std::size_t rows;
  /// Writes primitive `i` to lane[width * row] for each row. Unused lanes are filled with
  /// `unused`, which no ray meets.
  void (*pack)(const Primitives& primitives, std::size_t i, float* lane);
  float unused;
  /// The box around the part of a packed primitive that rays see without the footprint of a pixel;
  /// empty if they see nothing.
  Box (*box)(const Primitives& primitives, const float* lane);
  /// The largest growth of that box by the footprint, in widths of a pixel.
  float (*footprint)(const Primitives& primitives);

  /// Splats: the function for the vectors of this processor. Null for surfaces.
  CollectSplats* (*collect)() = nullptr;
  /// Splats: the colour, by RayInLayer::eye.
  glm::vec3 (*color)(const TracedLayer& layer, const RayInLayer& ray, std::uint32_t lane) = nullptr;
  /// Surfaces: replaces `nearest` by a visible point of the layer that is nearer. At equal
  /// distances the earlier layer, then the lower index wins. Null for splats.
  void (*intersect)(const TracedLayer& layer, const Ray& ray, SurfaceOnRay& nearest) = nullptr;
};

/// The kernel that treats these primitives.
const RayKernel& ray_kernel_of(const Primitives& primitives);

extern const RayKernel gaussian_rays, disc_rays, window_rays, corner_window_rays, neural_rays,
    triangle_rays;

/// RayKernel::color of splats with one colour.
glm::vec3 splat_color(const TracedLayer& layer, const RayInLayer& ray, std::uint32_t lane);
/// max(0, 1/2 + sum_i Y_i c_i) of splat or corner `element`, at the direction of `from_eye`.
glm::vec3 harmonics_color(const SplatColor& color, std::size_t element, const glm::dvec3& from_eye);

/// The profile's limit as an exponent: the squared distance from the centre, in deviations, at
/// which a Gaussian reaches the smallest alpha; negative if it never does.
float largest_squared(float opacity, const SplatProfile& profile);

}  // namespace tureen::tracing
