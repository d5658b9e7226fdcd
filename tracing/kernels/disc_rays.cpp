// Flat Gaussians on their plane (2DGS, REdiSplats) on rays (tracing/kernels/ray_kernel.hpp).
#include "tracing/kernels/ellipsoid.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tracing/kernels/disc_rays.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "tracing/kernels/ellipsoid-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::tracing::HWY_NAMESPACE {

void collect_discs(const TracedLayer& layer, const RayInLayer& ray, float from, float to,
                   std::vector<SplatOnRay>& hits) {
  collect_on<EllipsoidOnRay<true>>(layer, ray, from, to, hits);
}

}  // namespace tureen::tracing::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tureen::tracing {

HWY_EXPORT(collect_discs);

constexpr RayKernel disc_rays{
    .draws =
        [](const Primitives& primitives) {
          return are_gaussians(primitives, SplatProfile::Projection::plane);
        },
    .count = ellipsoid_count,
    .rows = ellipsoid_row::count,
    .pack = pack_ellipsoid,
    .unused = -std::numeric_limits<float>::infinity(),
    .box = ellipsoid_box,
    .footprint = ellipsoid_footprint,
    .collect =
        [](const TracedLayer& layer, const RayInLayer& ray, float from, float to,
           std::vector<SplatOnRay>& hits) {
          HWY_DYNAMIC_DISPATCH(collect_discs)(layer, ray, from, to, hits);
        },
    .color = splat_color};

}  // namespace tureen::tracing
#endif
