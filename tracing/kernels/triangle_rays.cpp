// Faces of soups and meshes on rays (tracing/kernels/ray_kernel.hpp). Vectors of floats find the
// faces that a ray may meet; each is then tested in double precision, with edge functions that both
// faces at an edge round alike: no ray slips through between them.

#include "tracing/appearance.hpp"
#include "tracing/kernels/face_on_ray.hpp"
#include "tracing/kernels/ray_kernel.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tracing/kernels/triangle_rays.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "tracing/bvh/traverse-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::tracing::HWY_NAMESPACE {

/// The faces of a block that the ray may meet, as bits.
HWY_INLINE unsigned faces_that_may_meet(const float* values, const RayInLayer& ray) {
  const Vector3 along = of_ray(ray.along);
  unsigned result = 0;
  for (std::size_t part = 0; part < parts; ++part) {
    const Block block{values, part};
    const Vector3 v[3] = {from_origin(ray, block.rows(0)), from_origin(ray, block.rows(3)),
                          from_origin(ray, block.rows(6))};
    Floats largest = hn::Zero(d);
    for (const Vector3& each : v)
      largest =
          hn::Max(largest, hn::Max(hn::Abs(each.x), hn::Max(hn::Abs(each.y), hn::Abs(each.z))));
    // An edge function has 9 roundings of products up to 3 |v_i| |v_j|: below 48 / 2^24.
    const Floats tolerance = hn::Mul(constant(4e-6f), hn::Mul(largest, largest));
    Mask above = hn::Eq(tolerance, tolerance), below = above;
    for (std::size_t k = 0; k < 3; ++k) {
      const Floats e = dot(along, cross(v[(k + 1) % 3], v[(k + 2) % 3]));
      above = hn::And(above, hn::Ge(e, hn::Neg(tolerance)));
      below = hn::And(below, hn::Le(e, tolerance));
    }
    result |= bits_of(hn::Or(above, below)) << (part * lanes);
  }
  return result;
}

void intersect_faces(const TracedLayer& layer, const TriangleSoup& soup, const Ray& ray,
                     SurfaceOnRay& nearest) {
  const RayInLayer own = layer.in_layer(ray, nearest.distance);
  // A float that is not below the distance.
  const auto limit = [&] { return float(nearest.distance) * (1 + 0x1p-22f); };
  for_each_leaf_in_order(layer.bvh(), own, limit(), [&](std::uint32_t leaf) {
    for (unsigned bits = faces_that_may_meet(layer.block(leaf), own); bits != 0; bits &= bits - 1) {
      const auto lane = std::uint32_t(leaf * width) + std::uint32_t(std::countr_zero(bits));
      const std::uint32_t face = layer.primitive(lane);
      if (ray.from == FaceOfLayer{layer.index(), face}) continue;
      const FaceOnRay hit = face_on_ray(soup, face, own);
      const double distance = hit.distance * layer.scale();
      const bool is_nearer = distance < nearest.distance ||
                             (distance == nearest.distance && nearest.face.layer == layer.index() &&
                              face < nearest.face.face);
      if (hit.exists && is_nearer && is_visible(soup, {face, hit.b0, hit.b1}))
        nearest = {{layer.index(), face}, hit.b0, hit.b1, distance};
    }
    return limit();
  });
}

}  // namespace tureen::tracing::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tureen::tracing {

HWY_EXPORT(intersect_faces);

namespace {

const TriangleSoup& soup_of(const Primitives& primitives) {
  return std::get<TriangleSoup>(primitives);
}

}  // namespace

constexpr RayKernel triangle_rays{
    .draws =
        [](const Primitives& primitives) {
          return std::holds_alternative<TriangleSoup>(primitives);
        },
    .count = [](const Primitives& primitives) { return soup_of(primitives).triangles.size(); },
    .rows = 9,
    .pack =
        [](const Primitives& primitives, std::size_t i, float* lane) {
          const TriangleSoup& soup = soup_of(primitives);
          for (std::size_t k = 0; k < 9; ++k)
            lane[width * k] = soup.positions[soup.triangles[i][int(k / 3)]][int(k % 3)];
        },
    .unused = std::numeric_limits<float>::quiet_NaN(),
    .box =
        [](const Primitives&, const float* lane) {
          Box box;
          for (std::size_t k = 0; k < 9; k += 3)
            box.add({lane[width * k], lane[width * (k + 1)], lane[width * (k + 2)]});
          return box;
        },
    .footprint = [](const Primitives&) { return 0.0f; },
    .intersect =
        [](const TracedLayer& layer, const Ray& ray, SurfaceOnRay& nearest) {
          HWY_DYNAMIC_DISPATCH(intersect_faces)(layer, soup_of(layer.primitives()), ray, nearest);
        }};

}  // namespace tureen::tracing
#endif
