// The derivatives through the colour of splats. Included once for each target of Highway.
#if defined(TUREEN_COLOR_GRADIENT_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TUREEN_COLOR_GRADIENT_INL
#undef TUREEN_COLOR_GRADIENT_INL
#else
#define TUREEN_COLOR_GRADIENT_INL
#endif

#include "splatting/harmonics-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::trainer::HWY_NAMESPACE {
namespace shared {

using namespace splatting::HWY_NAMESPACE;

/// The derivatives by a harmonic's coefficient are its basis function times `color`.
struct ColorGradient {
  Vector3 color;
  Floats basis[25];
  Vector3 by_offset;  // through the direction, by the centre's offset from the eye
};

/// Of the splats from `i` on. `coefficients` is the row of the first red one, `offset` the centre's
/// from the eye in any unit of length, and `by_color` the derivative by the drawn colour.
/// ColorGradient::by_offset is in one over that unit.
HWY_INLINE ColorGradient color_gradient_of(int degree, const float* coefficients,
                                           std::size_t stride, std::size_t i, const Vector3& offset,
                                           const Vector3& by_color) {
  ColorGradient result;
  const Vector3 direction = unit(offset);
  harmonics_basis(degree, direction, result.basis);
  const int count = (degree + 1) * (degree + 1);
  const auto coefficient = [&](int k, std::size_t channel) {
    return hn::Load(d, coefficients + (3 * std::size_t(k) + channel) * stride + i);
  };
  Vector3 color{constant(0.5f), constant(0.5f), constant(0.5f)};
  for (int k = 0; k < count; ++k) {
    color.x = hn::MulAdd(result.basis[k], coefficient(k, 0), color.x);
    color.y = hn::MulAdd(result.basis[k], coefficient(k, 1), color.y);
    color.z = hn::MulAdd(result.basis[k], coefficient(k, 2), color.z);
  }
  // 0 where the colour is limited, as in harmonics_color().
  const auto where_free = [&](Floats value, Floats by_value) {
    return hn::IfThenElseZero(hn::Gt(value, hn::Zero(d)), by_value);
  };
  result.color = {where_free(color.x, by_color.x), where_free(color.y, by_color.y),
                  where_free(color.z, by_color.z)};
  result.by_offset = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  if (degree == 0) return result;
  Floats weights[16];
  for (int k = 0; k < count; ++k)
    weights[k] = dot({coefficient(k, 0), coefficient(k, 1), coefficient(k, 2)}, result.color);
  const Vector3 slope = harmonics_slope(degree, direction, weights);
  const Floats radial = dot(slope, direction);
  const Floats by_length = hn::Div(constant(1.0f), hn::Sqrt(dot(offset, offset)));
  result.by_offset = {hn::Mul(hn::NegMulAdd(radial, direction.x, slope.x), by_length),
                      hn::Mul(hn::NegMulAdd(radial, direction.y, slope.y), by_length),
                      hn::Mul(hn::NegMulAdd(radial, direction.z, slope.z), by_length)};
  return result;
}

}  // namespace shared
}  // namespace tureen::trainer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
