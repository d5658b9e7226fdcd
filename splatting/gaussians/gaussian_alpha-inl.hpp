// The alpha of projected Gaussians. Included once for each target of Highway.
#if defined(TUREEN_GAUSSIAN_ALPHA_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TUREEN_GAUSSIAN_ALPHA_INL
#undef TUREEN_GAUSSIAN_ALPHA_INL
#else
#define TUREEN_GAUSSIAN_ALPHA_INL
#endif

#include <algorithm>

#include "splatting/gaussians/gaussian_kernels.hpp"
#include "splatting/tiles/blending-inl.hpp"
#include "splatting/vector_math-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::splatting::HWY_NAMESPACE {

/// sqrt(log2(e) / 2): exp(-u^2 / 2) = 2^-(factor u)^2.
inline constexpr float exponent_factor = 0.849321800f;

/// The logarithm to the base 2 of alpha at image points, before any limit.
HWY_INLINE Floats log_alpha_of(const GaussianEntry& entry, Floats x, Floats y) {
  const Floats dx = hn::Sub(x, constant(entry.x)), dy = hn::Sub(y, constant(entry.y));
  const Floats u = hn::MulAdd(constant(entry.p), dx, hn::Mul(constant(entry.q), dy));
  const Floats v = hn::Mul(constant(entry.r), dy);
  return hn::NegMulAdd(u, u, hn::NegMulAdd(v, v, constant(entry.log_opacity)));
}

/// `alpha_of` of blend_entries().
struct GaussianAlpha {
  Floats min_log_alpha;

  /// By a lower bound of the exponent: the smallest |u| and |v| in each block, for p and r > 0.
  HWY_INLINE unsigned blocks(const GaussianEntry& entry, const BlockCorners& corners) const {
    const auto set = [](float value) { return hn::Set(of_blocks, value); };
    const Blocks dx = hn::Sub(corners.x, set(entry.x)), dy = hn::Sub(corners.y, set(entry.y));
    const Blocks u = hn::MulAdd(set(entry.p), dx, hn::Mul(set(entry.q), dy));
    const float slope = block_extent * entry.q;
    const Blocks from_u = hn::Add(u, set(std::min(slope, 0.0f)));
    const Blocks to_u = largest_in_block(u, entry.p, entry.q);
    const Blocks to_dy = hn::Add(dy, set(block_extent));
    const auto smallest = [](Blocks from, Blocks to) {
      return hn::ZeroIfNegative(hn::Max(from, hn::Neg(to)));
    };
    const Blocks least_u = smallest(from_u, to_u);
    const Blocks least_v = hn::Mul(set(entry.r), smallest(dy, to_dy));
    const Blocks bound =
        hn::NegMulAdd(least_u, least_u, hn::NegMulAdd(least_v, least_v, set(entry.log_opacity)));
    return bits_of(of_blocks, hn::Ge(bound, set(hn::GetLane(min_log_alpha))));
  }

  HWY_INLINE Mask operator()(const GaussianEntry& entry, Floats x, Floats y, Floats inverse_behind,
                             Floats& alpha) const {
    const Floats log_alpha = log_alpha_of(entry, x, y);
    Mask covered = hn::Ge(log_alpha, min_log_alpha);
    if (none(covered)) return covered;
    covered = hn::And(covered, hn::Gt(constant(entry.inverse_depth), inverse_behind));
    alpha = exp2_of(hn::Max(log_alpha, min_log_alpha));
    return covered;
  }
};

/// The depth of the largest density of one Gaussian along rays, at least that of the near plane.
struct GaussianPeakDepth {
  const ImageView& view;
  GaussianPeak peak;

  HWY_INLINE Floats operator()(const GaussianEntry&, Floats x, Floats y, Floats) const {
    const Floats ray_x = hn::Mul(hn::Sub(x, constant(view.cx)), constant(1 / view.fx));
    const Floats ray_y = hn::Mul(hn::Sub(y, constant(view.cy)), constant(1 / view.fy));
    // From the centre to the ray's point at the same depth: both are large, their difference not.
    const Floats center_z = constant(peak.center[2]);
    const Floats off_x = hn::NegMulAdd(center_z, ray_x, constant(peak.center[0]));
    const Floats off_y = hn::NegMulAdd(center_z, ray_y, constant(peak.center[1]));
    Floats numerator = hn::Zero(d), denominator = hn::Zero(d);
    for (std::size_t k = 0; k < 3; ++k) {
      const float* axis = peak.axes + 3 * k;
      const Floats axis_x = constant(axis[0]), axis_y = constant(axis[1]);
      const Floats along = hn::MulAdd(axis_x, ray_x, hn::MulAdd(axis_y, ray_y, constant(axis[2])));
      const Floats off = hn::MulAdd(axis_x, off_x, hn::Mul(axis_y, off_y));
      numerator = hn::MulAdd(along, off, numerator);
      denominator = hn::MulAdd(along, along, denominator);
    }
    // A disc seen edge-on has no single largest density.
    const Floats depth = hn::Add(center_z, hn::Div(numerator, denominator));
    return hn::IfThenElse(hn::IsFinite(depth), hn::Max(depth, constant(view.near)), center_z);
  }
};

}  // namespace tureen::splatting::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
