// Colours by spherical harmonics. Included once for each target of Highway.
#if defined(TUREEN_HARMONICS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TUREEN_HARMONICS_INL
#undef TUREEN_HARMONICS_INL
#else
#define TUREEN_HARMONICS_INL
#endif

#include "scene/spherical_harmonics.hpp"
#include "splatting/vector_math-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::splatting::HWY_NAMESPACE {

/// The basis functions of scene/spherical_harmonics.hpp at the unit direction `at`.
HWY_INLINE void harmonics_basis(int degree, const Vector3& at, Floats (&out)[25]) {
  const auto times = [](float factor, Floats value) { return hn::Mul(constant(factor), value); };
  const auto factor = [](int i) { return float(harmonics::factors[i]); };
  const Floats x = at.x, y = at.y, z = at.z;
  out[0] = constant(factor(0));
  if (degree < 1) return;
  out[1] = times(factor(1), y);
  out[2] = times(factor(2), z);
  out[3] = times(factor(3), x);
  if (degree < 2) return;
  const Floats xx = hn::Mul(x, x), yy = hn::Mul(y, y), zz = hn::Mul(z, z);
  const Floats xy = hn::Mul(x, y), yz = hn::Mul(y, z), xz = hn::Mul(x, z);
  const Floats difference = hn::Sub(xx, yy), planar = hn::Add(xx, yy);
  out[4] = times(factor(4), xy);
  out[5] = times(factor(5), yz);
  out[6] = times(factor(6), hn::Sub(hn::Add(zz, zz), planar));
  out[7] = times(factor(7), xz);
  out[8] = times(factor(8), difference);
  if (degree < 3) return;
  const Floats three_xx = times(3.0f, xx), three_yy = times(3.0f, yy);
  const Floats four_zz = hn::Sub(times(4.0f, zz), planar);
  out[9] = times(factor(9), hn::Mul(y, hn::Sub(three_xx, yy)));
  out[10] = times(factor(10), hn::Mul(xy, z));
  out[11] = times(factor(11), hn::Mul(y, four_zz));
  out[12] = times(factor(12), hn::Mul(z, hn::Sub(hn::Add(zz, zz), times(3.0f, planar))));
  out[13] = times(factor(13), hn::Mul(x, four_zz));
  out[14] = times(factor(14), hn::Mul(z, difference));
  out[15] = times(factor(15), hn::Mul(x, hn::Sub(xx, three_yy)));
  if (degree < 4) return;
  const Floats seven_zz = times(7.0f, zz);
  const Floats below_1 = hn::Sub(seven_zz, constant(1.0f));
  const Floats below_3 = hn::Sub(seven_zz, constant(3.0f));
  const Floats steep_x = hn::Sub(xx, three_yy), steep_y = hn::Sub(three_xx, yy);
  out[16] = times(factor(16), hn::Mul(xy, difference));
  out[17] = times(factor(17), hn::Mul(yz, steep_y));
  out[18] = times(factor(18), hn::Mul(xy, below_1));
  out[19] = times(factor(19), hn::Mul(yz, below_3));
  out[20] =
      times(factor(20), hn::MulAdd(zz, hn::Sub(times(35.0f, zz), constant(30.0f)), constant(3.0f)));
  out[21] = times(factor(21), hn::Mul(xz, below_3));
  out[22] = times(factor(22), hn::Mul(difference, below_1));
  out[23] = times(factor(23), hn::Mul(xz, steep_x));
  out[24] = times(factor(24), hn::Sub(hn::Mul(xx, steep_x), hn::Mul(yy, steep_y)));
}

/// The sum of the gradients of the basis functions up to `degree` <= 3, times `weights`, at the
/// unit direction `at`. Only its part across `at` has a meaning: the functions are defined on the
/// sphere.
HWY_INLINE Vector3 harmonics_slope(int degree, const Vector3& at, const Floats (&weights)[16]) {
  const Floats zero = hn::Zero(d);
  Vector3 sum{zero, zero, zero};
  if (degree < 1) return sum;
  const auto times = [](float factor, Floats value) { return hn::Mul(constant(factor), value); };
  const auto factor = [](int i) { return float(harmonics::factors[i]); };
  const Floats x = at.x, y = at.y, z = at.z;
  const auto add = [&](Floats weight, Floats by_x, Floats by_y, Floats by_z) {
    sum.x = hn::MulAdd(weight, by_x, sum.x);
    sum.y = hn::MulAdd(weight, by_y, sum.y);
    sum.z = hn::MulAdd(weight, by_z, sum.z);
  };
  sum.y = times(factor(1), weights[1]);
  sum.z = times(factor(2), weights[2]);
  sum.x = times(factor(3), weights[3]);
  if (degree < 2) return sum;
  add(times(factor(4), weights[4]), y, x, zero);
  add(times(factor(5), weights[5]), zero, z, y);
  add(times(2 * factor(6), weights[6]), hn::Neg(x), hn::Neg(y), hn::Add(z, z));
  add(times(factor(7), weights[7]), z, zero, x);
  add(times(2 * factor(8), weights[8]), x, hn::Neg(y), zero);
  if (degree < 3) return sum;
  const Floats xx = hn::Mul(x, x), yy = hn::Mul(y, y), zz = hn::Mul(z, z);
  const Floats xy = hn::Mul(x, y), yz = hn::Mul(y, z), xz = hn::Mul(x, z);
  const Floats difference = hn::Sub(xx, yy), four_zz = times(4.0f, zz);
  const Floats twice_xy = hn::Add(xy, xy);
  const Floats steep = times(3.0f, difference);
  add(times(factor(9), weights[9]), times(6.0f, xy), steep, zero);
  add(times(factor(10), weights[10]), yz, xz, xy);
  add(times(factor(11), weights[11]), hn::Neg(twice_xy),
      hn::Sub(hn::Sub(four_zz, xx), times(3.0f, yy)), times(8.0f, yz));
  add(times(float(3 * harmonics::factors[12]), weights[12]), times(-2.0f, xz), times(-2.0f, yz),
      hn::Sub(hn::Add(zz, zz), hn::Add(xx, yy)));
  add(times(factor(13), weights[13]), hn::Sub(hn::Sub(four_zz, yy), times(3.0f, xx)),
      hn::Neg(twice_xy), times(8.0f, xz));
  add(times(factor(14), weights[14]), hn::Add(xz, xz), times(-2.0f, yz), difference);
  add(times(factor(15), weights[15]), steep, times(-6.0f, xy), zero);
  return sum;
}

/// max(0, 1/2 + sum_i Y_i c_i) for the splats from `i` on, but at most 65504, as on the device: no
/// product with it is infinite. `from_eye` points to the splat; at the eye, the direction is that
/// of z. `coefficients` is the row of the first red one.
HWY_INLINE Vector3 harmonics_color(int degree, const Vector3& from_eye, const float* coefficients,
                                   std::size_t stride, std::size_t i) {
  Vector3 direction = unit(from_eye);
  const Mask at_eye = hn::Eq(dot(direction, direction), hn::Zero(d));
  direction.z = hn::IfThenElse(at_eye, constant(1.0f), direction.z);
  Floats basis[25];
  harmonics_basis(degree, direction, basis);
  Vector3 sum{constant(0.5f), constant(0.5f), constant(0.5f)};
  const int count = (degree + 1) * (degree + 1);
  for (int k = 0; k < count; ++k) {
    const float* row = coefficients + 3 * std::size_t(k) * stride + i;
    sum.x = hn::MulAdd(basis[k], hn::Load(d, row), sum.x);
    sum.y = hn::MulAdd(basis[k], hn::Load(d, row + stride), sum.y);
    sum.z = hn::MulAdd(basis[k], hn::Load(d, row + 2 * stride), sum.z);
  }
  // The comparison is false for NaN, which overflow gives.
  const auto limited = [](Floats value) {
    return hn::IfThenElseZero(hn::Gt(value, hn::Zero(d)), hn::Min(value, constant(65504.0f)));
  };
  return {limited(sum.x), limited(sum.y), limited(sum.z)};
}

}  // namespace tureen::splatting::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
