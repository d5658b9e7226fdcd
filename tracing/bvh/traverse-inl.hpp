// Rays through a tree and its blocks. Included once for each target of Highway.
#if defined(TUREEN_TRAVERSE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TUREEN_TRAVERSE_INL
#undef TUREEN_TRAVERSE_INL
#else
#define TUREEN_TRAVERSE_INL
#endif

#define TUREEN_LANES 8

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include "splatting/vector_math-inl.hpp"
#include "tracing/kernels/ray_kernel.hpp"
#include "tracing/layer.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::tracing::HWY_NAMESPACE {

using namespace splatting::HWY_NAMESPACE;  // NOLINT: its functions of vectors

/// Vectors of a node or a block.
inline constexpr std::size_t parts = width / lanes;

HWY_INLINE unsigned bits_of(Mask mask) {
  std::uint8_t bits[8] = {};
  hn::StoreMaskBits(d, mask, bits);
  return bits[0];
}

/// The part of a ray in a box, in layer units.
struct Span {
  float near, far;
};

/// The children of a node that a ray meets, as bits, and the ray's parts in their boxes.
struct Children {
  alignas(32) float near[width], far[width];
  unsigned met = 0;

  /// Those that overlap the distances [from, to), in world units.
  ///
  /// Each step rounds monotonically: a child's part lies in its parent's, with the same bits from
  /// any traversal. Distances of hits, limited to the part of their leaf, are thus found in
  /// whichever interval they lie.
  HWY_INLINE Children(const Node& node, const RayInLayer& ray, float from, float to) {
    for (std::size_t part = 0; part < parts; ++part) {
      Floats below[3], above[3], squared = hn::Zero(d);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const Floats origin = constant(ray.high[axis]);
        below[axis] = hn::Sub(hn::Load(d, node.low[axis] + part * lanes), origin);
        above[axis] = hn::Sub(hn::Load(d, node.high[axis] + part * lanes), origin);
        const Floats farthest = hn::Max(hn::Neg(below[axis]), above[axis]);
        squared = hn::MulAdd(farthest, farthest, squared);
      }
      const Floats grow =
          hn::MulAdd(constant(ray.grow_by_distance), hn::Sqrt(squared), constant(ray.grow));
      Floats first = hn::Zero(d), last = constant(3e38f);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const Floats inverse = constant(ray.inverse[axis]);
        const Floats low = hn::Sub(below[axis], grow), high = hn::Add(above[axis], grow);
        const bool forward = ray.inverse[axis] > 0;
        first = hn::Max(first, hn::Mul(forward ? low : high, inverse));
        last = hn::Min(last, hn::Mul(forward ? high : low, inverse));
      }
      const Floats scale = constant(ray.scale);
      const Mask met_here =
          hn::And(hn::Le(first, last), hn::And(hn::Lt(hn::Mul(first, scale), constant(to)),
                                               hn::Ge(hn::Mul(last, scale), constant(from))));
      hn::Store(first, d, near + part * lanes);
      hn::Store(last, d, far + part * lanes);
      met |= bits_of(met_here) << (part * lanes);
    }
    met &= (1u << node.count) - 1;
  }
};

/// Calls act(leaf, span) for each leaf whose box the ray meets at distances in [from, to), in no
/// order.
template <class Act>
HWY_INLINE void for_each_leaf(const Bvh& bvh, const RayInLayer& ray, float from, float to,
                              const Act& act) {
  // At most Builder's depth of 24, and below it one halving of at most 2^32 items per node.
  std::uint32_t stack[(24 + 32) * width];
  std::size_t size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const Node& node = bvh.nodes()[stack[--size]];
    const Children children(node, ray, from, to);
    for (unsigned met = children.met; met != 0; met &= met - 1) {
      const auto i = std::size_t(std::countr_zero(met));
      const std::uint32_t child = node.child[i];
      if (child & Node::leaf_bit)
        act(child & ~Node::leaf_bit, Span{children.near[i], children.far[i]});
      else
        stack[size++] = child;
    }
  }
}

/// The same from near to far while act(leaf) returns the smaller distance up to which leaves are of
/// interest.
template <class Act>
HWY_INLINE void for_each_leaf_in_order(const Bvh& bvh, const RayInLayer& ray, float to,
                                       const Act& act) {
  struct Entry {
    std::uint32_t child;
    float near;  // in world units
  };
  Entry stack[(24 + 16) * width];
  std::size_t size = 0;
  stack[size++] = {0, 0};
  while (size > 0) {
    const Entry entry = stack[--size];
    if (!(entry.near < to)) continue;
    if (entry.child & Node::leaf_bit) {
      to = act(entry.child & ~Node::leaf_bit);
      continue;
    }
    const Node& node = bvh.nodes()[entry.child];
    const Children children(node, ray, 0.0f, to);
    const std::size_t first = size;
    for (unsigned met = children.met; met != 0; met &= met - 1) {
      const auto i = std::size_t(std::countr_zero(met));
      stack[size++] = {node.child[i], children.near[i] * ray.scale};
    }
    std::sort(stack + first, stack + size,
              [](const Entry& a, const Entry& b) { return a.near > b.near; });
  }
}

/// The block of a leaf, or a part of it. Rows have one value per primitive, because a vector reads
/// one value of several primitives at once.
struct Block {
  const float* values;
  std::size_t part;

  HWY_INLINE Floats row(std::size_t i) const {
    return hn::Load(d, values + i * width + part * lanes);
  }
  HWY_INLINE Vector3 rows(std::size_t i) const { return {row(i), row(i + 1), row(i + 2)}; }
};

HWY_INLINE Vector3 of_ray(const float (&values)[3]) {
  return {constant(values[0]), constant(values[1]), constant(values[2])};
}
/// A point of the layer, relative to the origin of the ray.
HWY_INLINE Vector3 from_origin(const RayInLayer& ray, const Vector3& point) {
  return difference(difference(point, of_ray(ray.high)), of_ray(ray.low));
}

/// The limits of a profile, for vectors.
struct AlphaLimits {
  float least, least_log, largest;

  HWY_INLINE explicit AlphaLimits(const SplatProfile& profile)
      : least(profile.min_alpha),
        least_log(std::log2(profile.min_alpha)),
        largest(profile.max_alpha) {}
};

/// What the splats of a layer share on a ray.
class SplatOfRay {
 public:
  SplatOfRay(const TracedLayer& layer, const RayInLayer& ray)
      : ray_(ray), profile_(std::get<Splats>(layer.primitives()).profile), limits_(profile_) {}

 protected:
  const RayInLayer& ray_;
  const SplatProfile& profile_;
  AlphaLimits limits_;
};

/// RayKernel::collect. `Splat`, a SplatOfRay, has
///   Mask at(block, distance, alpha)   the lanes that the ray meets, the distances of their hits,
///                                     > 0, in layer units, and alpha, at most the largest
template <class Splat>
void collect_on(const TracedLayer& layer, const RayInLayer& ray, float from, float to,
                std::vector<SplatOnRay>& hits) {
  const Splat splat(layer, ray);
  const std::uint32_t first = layer.first();
  for_each_leaf(layer.bvh(), ray, from, to, [&](std::uint32_t leaf, Span span) {
    const float* values = layer.block(leaf);
    for (std::size_t part = 0; part < parts; ++part) {
      Floats distance, alpha;
      Mask met = splat.at(Block{values, part}, distance, alpha);
      if (none(met)) continue;
      const Floats inside = hn::Min(hn::Max(distance, constant(span.near)), constant(span.far));
      const Floats in_world = hn::Mul(inside, constant(ray.scale));
      met = hn::And(met, hn::And(hn::Ge(in_world, constant(from)), hn::Lt(in_world, constant(to))));
      unsigned bits = bits_of(met);
      if (bits == 0) continue;
      alignas(32) float distances[lanes], alphas[lanes];
      hn::Store(in_world, d, distances);
      hn::Store(alpha, d, alphas);
      for (; bits != 0; bits &= bits - 1) {
        const auto i = std::size_t(std::countr_zero(bits));
        const auto lane = std::uint32_t(leaf * width + part * lanes + i);
        const std::uint64_t order = std::bit_cast<std::uint32_t>(distances[i]);
        hits.push_back({order << 32 | (first + layer.primitive(lane)), alphas[i], lane});
      }
    }
  });
}

}  // namespace tureen::tracing::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
