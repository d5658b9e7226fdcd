// Adam for vectors of splats. Included once for each target of Highway.
#if defined(TUREEN_SPLAT_ADAM_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TUREEN_SPLAT_ADAM_INL
#undef TUREEN_SPLAT_ADAM_INL
#else
#define TUREEN_SPLAT_ADAM_INL
#endif

#include <cmath>

#include "splatting/vector_math-inl.hpp"
#include "trainer/splats/splat_memory.hpp"
#include "trainer/splats/splat_step.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::trainer::HWY_NAMESPACE {
namespace shared {

using namespace splatting::HWY_NAMESPACE;

HWY_INLINE Floats exp_of(Floats x) {
  const Floats low = constant(-126.0f), high = constant(126.0f);
  return exp2_of(hn::Clamp(hn::Mul(x, constant(1.44269504f)), low, high));
}

/// Whether values are below 1e18, whose square is finite; false for NaN. A test of the bits.
HWY_INLINE Mask is_moderate(Floats value) {
  const hn::RebindToSigned<FloatTag> di;
  const auto magnitude = hn::And(hn::BitCast(di, value), hn::Set(di, 0x7fffffff));
  return hn::RebindMask(d, hn::Lt(magnitude, hn::BitCast(di, constant(1e18f))));
}

/// As trainer/common/kernels/adam.hpp.
class AdamOfSplats {
 public:
  /// `steps_done` counts the present one: at least 1. Splats outside of `moving` stay.
  HWY_INLINE AdamOfSplats(const SplatAdam& adam, Floats steps_done, Mask moving)
      : adam_(adam), moving_(moving) {
    const Floats one = constant(1.0f);
    const auto power = [&](float beta) {
      return exp2_of(hn::Max(hn::Mul(constant(std::log2(beta)), steps_done), constant(-126.0f)));
    };
    first_factor_ = hn::Div(one, hn::Sub(one, power(adam.beta1)));
    second_factor_ = hn::Div(one, hn::Sqrt(hn::Sub(one, power(adam.beta2))));
  }

  /// `lines`: the first moment, and in the next SplatMemory::Line the second one.
  HWY_INLINE void operator()(float rate, Floats gradient, float* value, float* lines) const {
    float* second_line = lines + SplatMemory::block;
    const Floats old_first = hn::Load(d, lines), old_second = hn::Load(d, second_line);
    const Floats first =
        hn::MulAdd(constant(adam_.beta1), old_first, hn::Mul(constant(1 - adam_.beta1), gradient));
    const Floats second =
        hn::MulAdd(constant(adam_.beta2), old_second,
                   hn::Mul(hn::Mul(constant(1 - adam_.beta2), gradient), gradient));
    const Floats old = hn::Load(d, value);
    const Floats size = hn::MulAdd(hn::Sqrt(second), second_factor_, constant(adam_.epsilon));
    const Floats moved =
        hn::Sub(old, hn::Div(hn::Mul(hn::Mul(constant(rate), first_factor_), first), size));
    hn::Store(hn::IfThenElse(moving_, moved, old), d, value);
    hn::Store(hn::IfThenElse(moving_, first, old_first), d, lines);
    hn::Store(hn::IfThenElse(moving_, second, old_second), d, second_line);
  }

 private:
  const SplatAdam& adam_;
  Mask moving_;
  Floats first_factor_, second_factor_;  // 1 / (1 - beta1^t), 1 / sqrt(1 - beta2^t)
};

}  // namespace shared
}  // namespace tureen::trainer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
