// Neural densities on rays (tracing/kernels/ray_kernel.hpp). As in the tiles, a neuron's integral
// over the part of the chord with half its length h, middle m and direction r is
// 2 h sinc(w . r h) cos(w . m + b1), which divides by no small number (docs/numerics.md, N1).
#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>

#include "tracing/kernels/ray_kernel.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tracing/kernels/neural_rays.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "tracing/bvh/traverse-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::tracing::HWY_NAMESPACE {

inline constexpr auto neurons = std::size_t(NeuralDensities::width);

/// Rows of a block.
namespace density_row {
enum : std::size_t {
  center = 0,
  sphere_from_layer = 3,  // S^-1 R^T, row by row: the ellipsoid becomes the unit sphere
  by_largest = 12,        // one over the largest semi-axis
  frequencies,            // times omega over the largest semi-axis
  phases = frequencies + 3 * neurons,  // times omega
  amplitudes = phases + neurons,
  offset = amplitudes + neurons,
  count
};
}

/// `Splat` of collect_on().
class DensityOnRay : private SplatOfRay {
 public:
  using SplatOfRay::SplatOfRay;

  HWY_INLINE Mask at(const Block& block, Floats& distance, Floats& alpha) const {
    namespace row = density_row;
    const Vector3 along = of_ray(ray_.along);
    const Vector3 to_origin = product(from_origin(ray_, block.rows(row::center)), constant(-1.0f));
    // The point of the ray nearest to the centre, and in the sphere's space the middle of the
    // chord, corrected once: the distance of the origin does not enter its rounding
    // (docs/numerics.md, N2).
    const Floats to_nearest = hn::Neg(dot(to_origin, along));
    const Vector3 nearest = sum(to_origin, product(along, to_nearest));
    const auto in_sphere = [&](const Vector3& v) {
      return Vector3{dot(block.rows(row::sphere_from_layer), v),
                     dot(block.rows(row::sphere_from_layer + 3), v),
                     dot(block.rows(row::sphere_from_layer + 6), v)};
    };
    const Vector3 direction = in_sphere(along);
    const Floats by_speed = hn::Div(constant(1.0f), dot(direction, direction));
    const Vector3 from = in_sphere(nearest);
    const auto step_to_middle = [&](const Vector3& point) {
      return hn::Neg(hn::Mul(dot(point, direction), by_speed));
    };
    const Floats first = step_to_middle(from);
    const Vector3 near_middle = sum(from, product(direction, first));
    const Floats second = step_to_middle(near_middle);
    const Vector3 chord_middle = sum(near_middle, product(direction, second));
    const Floats discriminant = hn::Sub(constant(1.0f), dot(chord_middle, chord_middle));
    Mask met = hn::Gt(discriminant, hn::Zero(d));
    if (none(met)) return met;

    const Floats half_chord = hn::Sqrt(hn::Mul(hn::ZeroIfNegative(discriminant), by_speed));
    const Floats shift = hn::Add(first, second), middle = hn::Add(to_nearest, shift);
    const Floats limit = constant(ray_.end);
    const Floats begin = hn::Max(hn::Neg(half_chord), hn::Neg(middle));
    const Floats end = hn::Min(half_chord, hn::Sub(limit, middle));
    met = hn::And(met, hn::Gt(end, begin));
    const Floats half = hn::Mul(constant(0.5f), hn::Sub(end, begin));
    const Floats at_middle = hn::Mul(constant(0.5f), hn::Add(begin, end));
    // From the distances of the ends, not from the chord's middle: densities that the origin and
    // the surface both cut then have one distance, and their order is that of indices, not of
    // rounding.
    distance = hn::Mul(constant(0.5f), hn::Add(hn::Max(hn::Sub(middle, half_chord), hn::Zero(d)),
                                               hn::Min(hn::Add(middle, half_chord), limit)));
    met = hn::And(met, hn::Gt(distance, hn::Zero(d)));
    if (none(met)) return met;

    const Vector3 point = sum(nearest, product(along, hn::Add(shift, at_middle)));
    Floats density = block.row(row::offset);
    for (std::size_t k = 0; k < neurons; ++k) {
      const Vector3 w = block.rows(row::frequencies + 3 * k);
      const Floats phase = hn::Add(dot(w, point), block.row(row::phases + k));
      density = hn::MulAdd(hn::Mul(block.row(row::amplitudes + k), cos_of(phase)),
                           sinc_of(hn::Mul(dot(w, along), half)), density);
    }
    const Floats depth = hn::Mul(hn::Mul(hn::Add(half, half), block.row(row::by_largest)), density);
    alpha = hn::Min(one_minus_exp_of(depth), constant(limits_.largest));
    // Both are false for NaN in some lane.
    return hn::And(met,
                   hn::And(hn::Gt(depth, hn::Zero(d)), hn::Ge(alpha, constant(limits_.least))));
  }
};

constexpr auto& collect_densities = collect_on<DensityOnRay>;

}  // namespace tureen::tracing::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tureen::tracing {

HWY_EXPORT(collect_densities);

namespace {

namespace density_row = HWY_NAMESPACE::density_row;
constexpr std::size_t neurons = HWY_NAMESPACE::neurons;

const NeuralDensities* densities_of(const Primitives& primitives) {
  const auto* splats = std::get_if<Splats>(&primitives);
  return splats ? std::get_if<NeuralDensities>(&splats->kernel) : nullptr;
}

void pack_density(const Primitives& primitives, std::size_t i, float* lane) {
  const NeuralDensities& densities = *densities_of(primitives);
  const glm::mat3 rotation = glm::mat3_cast(glm::normalize(densities.rotations[i]));
  const glm::vec3& axes = densities.semi_axes[i];
  const float by_largest = 1 / std::max({axes.x, axes.y, axes.z});
  const auto set = [&](std::size_t row, float value) { lane[width * row] = value; };
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = int(k);
    set(density_row::center + k, densities.centers[i][axis]);
    for (std::size_t c = 0; c < 3; ++c)
      set(density_row::sphere_from_layer + 3 * k + c, rotation[axis][int(c)] / axes[axis]);
  }
  set(density_row::by_largest, by_largest);
  const float* network = &densities.networks[NeuralDensities::parameters * i];
  for (std::size_t k = 0; k < 3 * neurons; ++k)
    set(density_row::frequencies + k, densities.omega * network[k] * by_largest);
  for (std::size_t k = 0; k < neurons; ++k) {
    set(density_row::phases + k, densities.omega * network[3 * neurons + k]);
    set(density_row::amplitudes + k, network[4 * neurons + k]);
  }
  set(density_row::offset, network[5 * neurons]);
}

Box density_box(const Primitives&, const float* lane) {
  glm::dvec3 squared(0.0);  // of the extents
  for (std::size_t k = 0; k < 3; ++k) {
    glm::dvec3 row;  // the axis over its length
    for (int c = 0; c < 3; ++c)
      row[c] = double(lane[width * (density_row::sphere_from_layer + 3 * k + std::size_t(c))]);
    const glm::dvec3 axis = row / glm::dot(row, row);
    squared += axis * axis;
  }
  Box box;
  for (int c = 0; c < 3; ++c) {
    // 0.01 % more for the rounding of the chord.
    const auto extent = float(1.0001 * std::sqrt(squared[c]));
    const float center = lane[width * (density_row::center + std::size_t(c))];
    box.low[c] = center - extent;
    box.high[c] = center + extent;
  }
  return box;
}

}  // namespace

constexpr RayKernel neural_rays{
    .draws = [](const Primitives& primitives) { return densities_of(primitives) != nullptr; },
    .count = [](const Primitives& primitives) { return densities_of(primitives)->centers.size(); },
    .rows = density_row::count,
    .pack = pack_density,
    .unused = std::numeric_limits<float>::quiet_NaN(),
    .box = density_box,
    .footprint = [](const Primitives&) { return 0.0f; },
    .collect = []() -> CollectSplats* { return HWY_DYNAMIC_DISPATCH(collect_densities); },
    .color = splat_color};

}  // namespace tureen::tracing
#endif
