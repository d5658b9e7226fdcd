// What Gaussians and discs share on rays: their blocks and boxes.
#pragma once

#include "tracing/kernels/ray_kernel.hpp"

namespace tureen::tracing {

/// The rows of their blocks, in layer units.
namespace ellipsoid_row {
enum : std::size_t {
  center = 0,
  axes = 3,  // three unit vectors
  variances = 12,
  log_opacity = 15,  // to the base 2
  count
};
}

/// SplatProfile::low_pass in squared widths of a pixel; 0: none.
double dilation_of(const SplatProfile& profile);

std::size_t ellipsoid_count(const Primitives& primitives);
void pack_ellipsoid(const Primitives& primitives, std::size_t i, float* lane);
Box ellipsoid_box(const Primitives& primitives, const float* lane);
float ellipsoid_footprint(const Primitives& primitives);
/// Whether the primitives are Gaussians that this projection draws.
bool are_gaussians(const Primitives& primitives, SplatProfile::Projection projection);

}  // namespace tureen::tracing
