// Functions of vectors for the kernels. Included once for each target of Highway.
#if defined(TUREEN_VECTOR_MATH_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TUREEN_VECTOR_MATH_INL
#undef TUREEN_VECTOR_MATH_INL
#else
#define TUREEN_VECTOR_MATH_INL
#endif

#include <hwy/highway.h>

#include <limits>

#include "splatting/image_view.hpp"

/// The largest number of lanes: the pixels of a block, unless a source defines another before it
/// includes this file. Functions for another number have other names for the linker.
#ifndef TUREEN_LANES
#define TUREEN_LANES 16
#endif
#undef TUREEN_OF_LANES
#define TUREEN_OF_LANES HWY_CONCAT(lanes_, TUREEN_LANES)

HWY_BEFORE_NAMESPACE();
namespace tureen::splatting::HWY_NAMESPACE {
inline namespace TUREEN_OF_LANES {

namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = hn::CappedTag<float, TUREEN_LANES>;
using Floats = hn::Vec<FloatTag>;
using Mask = hn::Mask<FloatTag>;
inline constexpr FloatTag d;
inline constexpr std::size_t lanes = hn::MaxLanes(d);

HWY_INLINE Floats constant(float value) { return hn::Set(d, value); }

/// The depth of splats that are not drawn.
HWY_INLINE Floats not_drawn() { return constant(std::numeric_limits<float>::quiet_NaN()); }

/// Whether no lane is set.
HWY_INLINE bool none(Mask mask) {
#if HWY_TARGET == HWY_WASM
  return !wasm_v128_any_true(mask.raw);  // AllFalse of Highway 1.0 moves both halves
#else
  return hn::AllFalse(d, mask);
#endif
}

/// 2^x for x in [-126, 127], to 2e-7 of the value. Polynomial: interpolation in Chebyshev's nodes
/// on [-1/2, 1/2].
HWY_INLINE Floats exp2_of(Floats x) {
  // The sum's last bits are x as a whole number. On some processors conversions take much longer.
  const Floats to_last_bits = constant(0x1.8p23f), shifted = hn::Add(x, to_last_bits);
  const Floats whole = hn::Sub(shifted, to_last_bits), f = hn::Sub(x, whole);
  Floats y = hn::MulAdd(constant(0.00133908634f), f, constant(0.00967603192f));
  y = hn::MulAdd(y, f, constant(0.0555035711f));
  y = hn::MulAdd(y, f, constant(0.240221075f));
  y = hn::MulAdd(y, f, constant(0.693147188f));
  y = hn::MulAdd(y, f, constant(1.0000000755f));
  const hn::RebindToSigned<FloatTag> di;
  const auto exponent = hn::ShiftLeft<23>(hn::Add(hn::BitCast(di, shifted), hn::Set(di, 127)));
  return hn::Mul(y, hn::BitCast(d, exponent));
}

/// log2(x) for normal x > 0, to 1.5e-7 of max(1, |log2(x)|). Polynomial of (m - 1) for the mantissa
/// m in [sqrt(1/2), sqrt(2)): interpolation of log2(m) / (m - 1) in Chebyshev's nodes.
HWY_INLINE Floats log2_of(Floats x) {
  const hn::RebindToSigned<FloatTag> di;
  // Bits of sqrt(1/2), so that the exponent changes there.
  const auto bits = hn::Sub(hn::BitCast(di, x), hn::Set(di, 0x3f3504f3));
  const auto exponent = hn::ShiftRight<23>(bits);
  const Floats m = hn::BitCast(d, hn::Sub(hn::BitCast(di, x), hn::ShiftLeft<23>(exponent)));
  const Floats t = hn::Sub(m, constant(1.0f));
  Floats y = hn::MulAdd(constant(-0.142759734f), t, constant(0.232652579f));
  y = hn::MulAdd(y, t, constant(-0.249271822f));
  y = hn::MulAdd(y, t, constant(0.287288882f));
  y = hn::MulAdd(y, t, constant(-0.360225182f));
  y = hn::MulAdd(y, t, constant(0.480916708f));
  y = hn::MulAdd(y, t, constant(-0.721352931f));
  y = hn::MulAdd(y, t, constant(1.44269499f));
  return hn::MulAdd(y, t, hn::ConvertTo(d, exponent));
}

/// An angle relative to the nearest multiple of pi, for its sine and cosine. For |x| up to 1e5
/// these are exact to 2e-7 + 6e-8 |x|, the rounding of x itself; the sine near 0 to 2e-7 of its
/// value. Beyond 1e7 the results have no meaning and may be large. The constants sum to pi, and
/// products of the first with whole numbers up to 2^16 are exact. Polynomials of the square:
/// interpolation of sin(r) / r and of cos(r) in Chebyshev's nodes on [-pi/2, pi/2].
class Angle {
 public:
  HWY_INLINE explicit Angle(Floats x) {
    // As in exp2_of(). An odd number of half turns changes the sign.
    const Floats to_last_bits = constant(0x1.8p23f);
    const Floats shifted = hn::MulAdd(x, constant(0.318309886f), to_last_bits);
    const Floats half_turns = hn::Sub(shifted, to_last_bits);
    rest_ = hn::NegMulAdd(half_turns, constant(3.140625f), x);
    rest_ = hn::NegMulAdd(half_turns, constant(9.67653589793e-4f), rest_);
    squared_ = hn::Mul(rest_, rest_);
    const hn::RebindToSigned<FloatTag> di;
    sign_ = hn::BitCast(d, hn::ShiftLeft<31>(hn::BitCast(di, shifted)));
  }
  HWY_INLINE Floats sine() const {
    Floats y = hn::MulAdd(constant(2.60510764e-6f), squared_, constant(-1.98090174e-4f));
    y = hn::MulAdd(y, squared_, constant(0.00833305017f));
    y = hn::MulAdd(y, squared_, constant(-0.166666579f));
    y = hn::Mul(hn::MulAdd(y, squared_, constant(0.999999996f)), rest_);
    return hn::Xor(y, sign_);
  }
  HWY_INLINE Floats cosine() const {
    Floats y = hn::MulAdd(constant(2.31524167e-5f), squared_, constant(-0.00138536295f));
    y = hn::MulAdd(y, squared_, constant(0.0416635732f));
    y = hn::MulAdd(y, squared_, constant(-0.499999048f));
    return hn::Xor(hn::MulAdd(y, squared_, constant(0.999999953f)), sign_);
  }

 private:
  Floats rest_, squared_, sign_;
};
/// With the errors of Angle.
HWY_INLINE Floats sin_of(Floats x) { return Angle(x).sine(); }
HWY_INLINE Floats cos_of(Floats x) { return Angle(x).cosine(); }

/// sin(x) / x, to 2e-7 for |x| up to 1e5.
HWY_INLINE Floats sinc_of(Floats x) {
  // Up to 2^-12, 1 is exact to 1e-8.
  const Mask large = hn::Gt(hn::Abs(x), constant(0x1p-12f));
  return hn::IfThenElse(large, hn::Div(sin_of(x), x), constant(1.0f));
}

/// 1 - exp(-x) for x >= 0, to 5e-6 of the value. Below 1/16 by the series, exact to 2e-9 there:
/// the difference would cancel.
HWY_INLINE Floats one_minus_exp_of(Floats x) {
  const Floats one = constant(1.0f);
  Floats series = hn::NegMulAdd(x, constant(0.2f), one);
  series = hn::NegMulAdd(hn::Mul(x, constant(0.25f)), series, one);
  series = hn::NegMulAdd(hn::Mul(x, constant(1.0f / 3.0f)), series, one);
  series = hn::NegMulAdd(hn::Mul(x, constant(0.5f)), series, one);
  const Floats exponent = hn::Max(hn::Mul(x, constant(-1.44269504f)), constant(-126.0f));
  return hn::IfThenElse(hn::Lt(x, constant(0.0625f)), hn::Mul(x, series),
                        hn::Sub(one, exp2_of(exponent)));
}

/// The largest power of 2 up to x; 0 for x below the smallest normal number.
HWY_INLINE Floats power_of_2_in(Floats x) {
  const hn::RebindToSigned<FloatTag> di;
  return hn::BitCast(d, hn::And(hn::BitCast(di, x), hn::Set(di, 0x7f800000)));
}

struct Vector3 {
  Floats x, y, z;
};
HWY_INLINE Floats dot(const Vector3& a, const Vector3& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}
HWY_INLINE Vector3 cross(const Vector3& a, const Vector3& b) {
  return {hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)), hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
          hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
}

HWY_INLINE Vector3 sum(const Vector3& a, const Vector3& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
HWY_INLINE Vector3 difference(const Vector3& a, const Vector3& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}

/// A position in layer coordinates, relative to the eye.
HWY_INLINE Vector3 from_eye(const ImageView& view, const Vector3& position) {
  const auto axis = [&](Floats value, int i) {
    return hn::Sub(hn::Sub(value, constant(view.eye_high[i])), constant(view.eye_low[i]));
  };
  return {axis(position.x, 0), axis(position.y, 1), axis(position.z, 2)};
}

HWY_INLINE Vector3 product(const Vector3& v, Floats factor) {
  return {hn::Mul(v.x, factor), hn::Mul(v.y, factor), hn::Mul(v.z, factor)};
}

/// `v` with length 1. It is scaled first: squares of floats underflow below 1e-19 and overflow
/// beyond 1e19. At 0 the direction is undefined, and the result is 0.
HWY_INLINE Vector3 unit(const Vector3& v) {
  const Floats largest = hn::Max(hn::Abs(v.x), hn::Max(hn::Abs(v.y), hn::Abs(v.z)));
  const Floats one = constant(1.0f), zero = hn::Zero(d);
  const Floats factor =
      hn::IfThenElse(hn::Gt(largest, constant(1e15f)), constant(1e-20f),
                     hn::IfThenElse(hn::Lt(largest, constant(1e-15f)), constant(1e30f), one));
  const Vector3 w = product(v, factor);
  const Floats inverse =
      hn::IfThenElse(hn::Gt(largest, zero), hn::Div(one, hn::Sqrt(dot(w, w))), zero);
  return product(w, inverse);
}

/// A matrix, row by row, times a vector.
HWY_INLINE Vector3 product(const float* matrix, const Vector3& v) {
  const auto row = [&](const float* m) {
    return dot({constant(m[0]), constant(m[1]), constant(m[2])}, v);
  };
  return {row(matrix), row(matrix + 3), row(matrix + 6)};
}
/// The transpose of a matrix, row by row, times a vector.
HWY_INLINE Vector3 transposed_product(const float* matrix, const Vector3& v) {
  const auto column = [&](const float* m) {
    return dot({constant(m[0]), constant(m[3]), constant(m[6])}, v);
  };
  return {column(matrix), column(matrix + 1), column(matrix + 2)};
}

}  // namespace TUREEN_OF_LANES
}  // namespace tureen::splatting::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
