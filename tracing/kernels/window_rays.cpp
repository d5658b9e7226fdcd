// Triangle windows on rays, in their own plane (tracing/kernels/ray_kernel.hpp): rho is the
// smallest distance from an edge over the inradius of the triangle in space, which is its
// barycentric times perimeter / length of the edge.
#include <cmath>
#include <glm/geometric.hpp>

#include "tracing/kernels/ray_kernel.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tracing/kernels/window_rays.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "tracing/bvh/traverse-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::tracing::HWY_NAMESPACE {

/// Rows of a block.
namespace window_row {
enum : std::size_t {
  corner = 0,
  edge1 = 3,  // to corner 1
  edge2 = 6,
  factors = 9,  // perimeter / length of the edge opposite each corner
  sigma = 12,
  log_opacity,
  count
};
}

/// `Splat` of collect_on().
class WindowOnRay : private SplatOfRay {
 public:
  using SplatOfRay::SplatOfRay;

  HWY_INLINE Mask at(const Block& block, Floats& distance, Floats& alpha) const {
    namespace row = window_row;
    const Vector3 along = of_ray(ray_.along);
    const Vector3 edge1 = block.rows(row::edge1), edge2 = block.rows(row::edge2);
    // Möller and Trumbore (1997), from the origin of the ray.
    const Vector3 to_origin = product(from_origin(ray_, block.rows(row::corner)), constant(-1.0f));
    const Vector3 across = cross(along, edge2);
    const Floats inverse = hn::Div(constant(1.0f), dot(edge1, across));
    const Vector3 other = cross(to_origin, edge1);
    const Floats b1 = hn::Mul(dot(to_origin, across), inverse);
    const Floats b2 = hn::Mul(dot(along, other), inverse);
    const Floats b0 = hn::Sub(hn::Sub(constant(1.0f), b1), b2);
    distance = hn::Mul(dot(edge2, other), inverse);
    const Vector3 factors = block.rows(row::factors);
    Floats rho =
        hn::Min(hn::Mul(b0, factors.x), hn::Min(hn::Mul(b1, factors.y), hn::Mul(b2, factors.z)));
    // False for NaN. Below 1e-37, its logarithm has no meaning, and alpha is 0.
    Mask met = hn::And(hn::Gt(rho, constant(1e-37f)), hn::Gt(distance, hn::Zero(d)));
    met = hn::And(met, hn::Lt(distance, constant(ray_.end)));
    if (none(met)) return met;
    rho = hn::IfThenElse(met, hn::Min(rho, constant(1.0f)), constant(1.0f));
    const Floats log_alpha =
        hn::MulAdd(block.row(row::sigma), log2_of(rho), block.row(row::log_opacity));
    met = hn::And(met, hn::Ge(log_alpha, constant(limits_.least_log)));
    alpha = hn::Min(exp2_of(hn::Max(log_alpha, constant(limits_.least_log))),
                    constant(limits_.largest));
    return met;
  }
};

constexpr auto& collect_windows = collect_on<WindowOnRay>;

}  // namespace tureen::tracing::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tureen::tracing {

HWY_EXPORT(collect_windows);

namespace {

namespace window_row = HWY_NAMESPACE::window_row;

const TriangleWindows* windows_of(const Primitives& primitives) {
  const auto* splats = std::get_if<Splats>(&primitives);
  return splats ? std::get_if<TriangleWindows>(&splats->kernel) : nullptr;
}

void pack_window(const Primitives& primitives, std::size_t i, float* lane) {
  const TriangleWindows& windows = *windows_of(primitives);
  const glm::vec3* corner = &windows.corners[3 * i];
  const glm::vec3 edge1 = corner[1] - corner[0], edge2 = corner[2] - corner[0];
  // Opposite the corners; in double, a needle's shortest edge keeps its digits.
  const double lengths[3] = {glm::length(glm::dvec3(corner[2]) - glm::dvec3(corner[1])),
                             glm::length(glm::dvec3(edge2)), glm::length(glm::dvec3(edge1))};
  const double perimeter = lengths[0] + lengths[1] + lengths[2];
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = int(k);
    lane[width * (window_row::corner + k)] = corner[0][axis];
    lane[width * (window_row::edge1 + k)] = edge1[axis];
    lane[width * (window_row::edge2 + k)] = edge2[axis];
    lane[width * (window_row::factors + k)] = float(perimeter / lengths[k]);
  }
  lane[width * window_row::sigma] = windows.sigma[i];
  lane[width * window_row::log_opacity] = std::log2(windows.opacity[i]);
}

Box window_box(const Primitives& primitives, const float* lane) {
  const auto vector = [&](std::size_t row) {
    return glm::vec3(lane[width * row], lane[width * (row + 1)], lane[width * (row + 2)]);
  };
  const float least = std::get<Splats>(primitives).profile.min_alpha;
  if (!(lane[width * window_row::log_opacity] >= std::log2(least))) return {};
  const glm::vec3 corner = vector(window_row::corner);
  Box box;
  box.add(corner);
  box.add(corner + vector(window_row::edge1));
  box.add(corner + vector(window_row::edge2));
  return box;
}

/// The colours of the corners, by the barycentrics in the window's own plane.
glm::vec3 corner_color(const TracedLayer& layer, const RayInLayer& ray, std::uint32_t lane) {
  const std::uint32_t i = layer.primitive(lane);
  const glm::vec3* corner = &windows_of(layer.primitives())->corners[3 * i];
  const glm::dvec3 start(corner[0]);
  const glm::dvec3 edge1 = glm::dvec3(corner[1]) - start, edge2 = glm::dvec3(corner[2]) - start;
  const glm::dvec3 to_origin = ray.origin - start, across = glm::cross(ray.direction, edge2);
  const double inverse = 1 / glm::dot(edge1, across);
  const double b1 = glm::dot(to_origin, across) * inverse;
  const double b2 = glm::dot(ray.direction, glm::cross(to_origin, edge1)) * inverse;
  const float weights[3] = {float(1 - b1 - b2), float(b1), float(b2)};
  glm::vec3 sum(0.0f);
  for (std::size_t k = 0; k < 3; ++k)
    sum += std::max(weights[k], 0.0f) * harmonics_color(std::get<Splats>(layer.primitives()).color,
                                                        3 * i + k, glm::dvec3(corner[k]) - ray.eye);
  return sum;
}

constexpr RayKernel window_kernel(bool (*draws)(const Primitives&),
                                  decltype(RayKernel::color) color) {
  return {
      .draws = draws,
      .count = [](const Primitives& primitives) { return windows_of(primitives)->sigma.size(); },
      .rows = window_row::count,
      .pack = pack_window,
      .unused = std::numeric_limits<float>::quiet_NaN(),
      .box = window_box,
      .footprint = [](const Primitives&) { return 0.0f; },
      .collect = []() -> CollectSplats* { return HWY_DYNAMIC_DISPATCH(collect_windows); },
      .color = color};
}

bool are_windows(const Primitives& primitives, bool per_corner) {
  return windows_of(primitives) && std::get<Splats>(primitives).color.per_corner == per_corner;
}

}  // namespace

constexpr RayKernel window_rays = window_kernel(
    [](const Primitives& primitives) { return are_windows(primitives, false); }, splat_color);
constexpr RayKernel corner_window_rays = window_kernel(
    [](const Primitives& primitives) { return are_windows(primitives, true); }, corner_color);

}  // namespace tureen::tracing
#endif
