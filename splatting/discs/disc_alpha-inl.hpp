// The alpha of projected discs. Included once for each target of Highway.
#if defined(TUREEN_DISC_ALPHA_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TUREEN_DISC_ALPHA_INL
#undef TUREEN_DISC_ALPHA_INL
#else
#define TUREEN_DISC_ALPHA_INL
#endif

#include "splatting/discs/disc_kernels.hpp"
#include "splatting/tiles/blending-inl.hpp"
#include "splatting/vector_math-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::splatting::HWY_NAMESPACE {

/// log2(e) / 2: exp(-q / 2) = 2^-(factor q).
inline constexpr float half_log2_e = 0.721347520f;

struct DiscConstants {
  float near;
  float inverse_screen_variance;  // 0: no screen filter
};

inline DiscConstants disc_constants(const ImageView& view) {
  return {view.near, view.screen_variance > 0 ? 1.0f / view.screen_variance : 0.0f};
}

/// A disc at image points.
struct DiscAt {
  Floats dx, dy;    // from the origin of projected_disc_row
  Floats u, v;      // where the ray meets the plane, in standard deviations
  Floats by_point;  // (u, v, 1) = by_point times the cross product of two lines
  Floats squared;   // of the distance from the centre in standard deviations
  Floats depth;
  Mask filtered;  // whether `squared` is that of the screen filter

  HWY_INLINE DiscAt(const DiscEntry& e, const DiscConstants& constants, Floats x, Floats y)
      : dx(hn::Sub(x, constant(e.x))), dy(hn::Sub(y, constant(e.y))) {
    // (u, v, 1) is orthogonal to both.
    const Vector3 k{hn::NegMulAdd(dx, constant(e.u_w), constant(e.u_x)),
                    hn::NegMulAdd(dx, constant(e.v_w), constant(e.v_x)),
                    hn::NegMulAdd(dx, constant(e.c_w), constant(e.c_x))};
    const Vector3 l{hn::NegMulAdd(dy, constant(e.u_w), constant(e.u_y)),
                    hn::NegMulAdd(dy, constant(e.v_w), constant(e.v_y)),
                    hn::NegMulAdd(dy, constant(e.c_w), constant(e.c_y))};
    const Vector3 point = cross(k, l);
    by_point = hn::Div(constant(1.0f), point.z);
    u = hn::Mul(point.x, by_point), v = hn::Mul(point.y, by_point);
    depth = hn::MulAdd(u, constant(e.u_w), hn::MulAdd(v, constant(e.v_w), constant(e.c_w)));
    squared = hn::MulAdd(u, u, hn::Mul(v, v));
    // False for a plane that contains the ray. Beyond 1e30 alpha is 0; u^2 + v^2 may be infinite.
    const Mask meets =
        hn::And(hn::Ge(depth, constant(constants.near)), hn::Lt(squared, constant(1e30f)));
    squared = hn::IfThenElse(meets, squared, constant(1e30f));
    filtered = hn::Not(meets);
    if (constants.inverse_screen_variance > 0) {
      const Floats on_screen =
          hn::Mul(hn::MulAdd(dx, dx, hn::Mul(dy, dy)), constant(constants.inverse_screen_variance));
      filtered = hn::Lt(on_screen, squared);
      squared = hn::Min(on_screen, squared);
      depth = hn::IfThenElse(filtered, constant(e.c_w), depth);
    }
  }

  /// The logarithm to the base 2 of alpha, before any limit.
  HWY_INLINE Floats log_alpha(const DiscEntry& e) const {
    return hn::NegMulAdd(constant(half_log2_e), squared, constant(e.log_opacity));
  }
};

/// `alpha_of` of blend_entries().
struct DiscAlpha {
  float min_log_alpha;
  DiscConstants constants;

  HWY_INLINE unsigned blocks(const DiscEntry&, const BlockCorners&) const { return all_blocks; }

  HWY_INLINE Mask operator()(const DiscEntry& e, Floats x, Floats y, Floats inverse_behind,
                             Floats& alpha) const {
    const DiscAt at(e, constants, x, y);
    const Floats log_alpha = at.log_alpha(e);
    Mask covered = hn::Ge(log_alpha, constant(min_log_alpha));
    if (none(covered)) return covered;
    covered = hn::And(covered, hn::Lt(hn::Mul(at.depth, inverse_behind), constant(1.0f)));
    alpha = exp2_of(hn::Max(log_alpha, constant(min_log_alpha)));
    return covered;
  }
};

/// The depth of a disc along rays, or of its centre for the screen filter.
struct DiscDepth {
  DiscConstants constants;

  HWY_INLINE Floats operator()(const DiscEntry& entry, Floats x, Floats y, Floats) const {
    return DiscAt(entry, constants, x, y).depth;
  }
};

}  // namespace tureen::splatting::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
