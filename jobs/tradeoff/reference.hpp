// The pictures that errors of drawing are measured against: one model, drawn by the oracle.
#pragma once

#include <functional>
#include <glm/vec3.hpp>

#include "oracle/oracle.hpp"

namespace tureen::tradeoff {

/// Where the reference looks. Both see float colours of unquantised texels.
enum class Samples {
  /// One a pixel, at the very points that the device samples: vertices lie on its subpixel grid
  /// (oracle::Coverage::snapped). What a device rounds before anybody has changed a setting is not
  /// the
  /// setting's fault: on small pictures it costs more than most settings do (docs/tradeoff.md).
  device,
  /// One a pixel, at its centre, of the triangles as they are.
  exact,
  /// antialiased_samples^2 a pixel, on a regular grid, of the triangles as they are.
  antialiased,
};

/// Samples a pixel and axis of Samples::antialiased. Supersampling with as many looks at the very
/// same points: how it differs from the reference is rounding and says nothing of antialiasing.
inline constexpr int antialiased_samples = 8;

/// GL_SUBPIXEL_BITS of the context that is current: how finely its device rounds vertices within a
/// pixel. 8, which nearly all have, where it tells nothing that the oracle could do (1 .. 16).
int device_subpixel_bits();

struct ReferenceOptions {
  Samples samples = Samples::device;
  int subpixel_bits = 8;  // of the device, for Samples::device: device_subpixel_bits()
  glm::vec3 background{0.0f};
  /// Called with the fraction done, 0..1; may throw to abandon the picture.
  std::function<void(double)> progress = {};
};

/// The picture over the background; alpha is coverage: the part of the rays that hit something.
/// Memory beside the picture: 12 bytes a ray, in strips of at most about 4 million rays.
ImageF reference_picture(const TriangleSoup& soup, glm::dvec3 origin, const Camera& camera,
                         const ReferenceOptions& options);

}  // namespace tureen::tradeoff
