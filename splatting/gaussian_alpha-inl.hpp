// The alpha of projected Gaussians. Included once for each target of Highway.
#if defined(TUREEN_GAUSSIAN_ALPHA_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TUREEN_GAUSSIAN_ALPHA_INL
#undef TUREEN_GAUSSIAN_ALPHA_INL
#else
#define TUREEN_GAUSSIAN_ALPHA_INL
#endif

#include "splatting/gaussian_kernels.hpp"
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

  HWY_INLINE Mask operator()(const GaussianEntry& entry, Floats x, Floats y, Floats inverse_behind,
                             Floats& alpha) const {
    const Floats log_alpha = log_alpha_of(entry, x, y);
    Mask covered = hn::Ge(log_alpha, min_log_alpha);
    if (hn::AllFalse(d, covered)) return covered;
    covered = hn::And(covered, hn::Gt(constant(entry.inverse_depth), inverse_behind));
    alpha = exp2_of(hn::Max(log_alpha, min_log_alpha));
    return covered;
  }
};

}  // namespace tureen::splatting::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
