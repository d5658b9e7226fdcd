// Colours by spherical harmonics. Included once for each target of Highway.
#if defined(TUREEN_HARMONICS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TUREEN_HARMONICS_INL
#undef TUREEN_HARMONICS_INL
#else
#define TUREEN_HARMONICS_INL
#endif

#include "splatting/vector_math-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::splatting::HWY_NAMESPACE {

/// The basis functions of scene/spherical_harmonics.hpp at the unit direction `at`.
HWY_INLINE void harmonics_basis(int degree, const Vector3& at, Floats (&out)[25]) {
  const auto times = [](float factor, Floats value) { return hn::Mul(constant(factor), value); };
  const Floats x = at.x, y = at.y, z = at.z;
  out[0] = constant(0.28209479177387814f);
  if (degree < 1) return;
  out[1] = times(-0.48860251190291992f, y);
  out[2] = times(0.48860251190291992f, z);
  out[3] = times(-0.48860251190291992f, x);
  if (degree < 2) return;
  const Floats xx = hn::Mul(x, x), yy = hn::Mul(y, y), zz = hn::Mul(z, z);
  const Floats xy = hn::Mul(x, y), yz = hn::Mul(y, z), xz = hn::Mul(x, z);
  const Floats difference = hn::Sub(xx, yy), planar = hn::Add(xx, yy);
  out[4] = times(1.0925484305920792f, xy);
  out[5] = times(-1.0925484305920792f, yz);
  out[6] = times(0.31539156525252005f, hn::Sub(hn::Add(zz, zz), planar));
  out[7] = times(-1.0925484305920792f, xz);
  out[8] = times(0.54627421529603959f, difference);
  if (degree < 3) return;
  const Floats three_xx = times(3.0f, xx), three_yy = times(3.0f, yy);
  const Floats four_zz = hn::Sub(times(4.0f, zz), planar);
  out[9] = times(-0.59004358992664352f, hn::Mul(y, hn::Sub(three_xx, yy)));
  out[10] = times(2.8906114426405538f, hn::Mul(xy, z));
  out[11] = times(-0.45704579946446572f, hn::Mul(y, four_zz));
  out[12] = times(0.37317633259011546f, hn::Mul(z, hn::Sub(hn::Add(zz, zz), times(3.0f, planar))));
  out[13] = times(-0.45704579946446572f, hn::Mul(x, four_zz));
  out[14] = times(1.4453057213202769f, hn::Mul(z, difference));
  out[15] = times(-0.59004358992664352f, hn::Mul(x, hn::Sub(xx, three_yy)));
  if (degree < 4) return;
  const Floats seven_zz = times(7.0f, zz);
  const Floats below_1 = hn::Sub(seven_zz, constant(1.0f));
  const Floats below_3 = hn::Sub(seven_zz, constant(3.0f));
  const Floats steep_x = hn::Sub(xx, three_yy), steep_y = hn::Sub(three_xx, yy);
  out[16] = times(2.5033429417967046f, hn::Mul(xy, difference));
  out[17] = times(-1.7701307697799304f, hn::Mul(yz, steep_y));
  out[18] = times(0.94617469575756008f, hn::Mul(xy, below_1));
  out[19] = times(-0.66904654355728921f, hn::Mul(yz, below_3));
  out[20] = times(0.10578554691520431f,
                  hn::MulAdd(zz, hn::Sub(times(35.0f, zz), constant(30.0f)), constant(3.0f)));
  out[21] = times(-0.66904654355728921f, hn::Mul(xz, below_3));
  out[22] = times(0.47308734787878004f, hn::Mul(difference, below_1));
  out[23] = times(-1.7701307697799304f, hn::Mul(xz, steep_x));
  out[24] = times(0.62583573544917614f, hn::Sub(hn::Mul(xx, steep_x), hn::Mul(yy, steep_y)));
}

/// The sum of the gradients of the basis functions up to `degree` <= 3, times `weights`, at the
/// unit direction `at`. Only its part across `at` has a meaning: the functions are defined on the
/// sphere.
HWY_INLINE Vector3 harmonics_slope(int degree, const Vector3& at, const Floats (&weights)[16]) {
  const Floats zero = hn::Zero(d);
  Vector3 sum{zero, zero, zero};
  if (degree < 1) return sum;
  const auto times = [](float factor, Floats value) { return hn::Mul(constant(factor), value); };
  const Floats x = at.x, y = at.y, z = at.z;
  const auto add = [&](Floats weight, Floats by_x, Floats by_y, Floats by_z) {
    sum.x = hn::MulAdd(weight, by_x, sum.x);
    sum.y = hn::MulAdd(weight, by_y, sum.y);
    sum.z = hn::MulAdd(weight, by_z, sum.z);
  };
  sum.y = times(-0.48860251190291992f, weights[1]);
  sum.z = times(0.48860251190291992f, weights[2]);
  sum.x = times(-0.48860251190291992f, weights[3]);
  if (degree < 2) return sum;
  add(times(1.0925484305920792f, weights[4]), y, x, zero);
  add(times(-1.0925484305920792f, weights[5]), zero, z, y);
  add(times(0.63078313050504009f, weights[6]), hn::Neg(x), hn::Neg(y), hn::Add(z, z));
  add(times(-1.0925484305920792f, weights[7]), z, zero, x);
  add(times(1.0925484305920792f, weights[8]), x, hn::Neg(y), zero);
  if (degree < 3) return sum;
  const Floats xx = hn::Mul(x, x), yy = hn::Mul(y, y), zz = hn::Mul(z, z);
  const Floats xy = hn::Mul(x, y), yz = hn::Mul(y, z), xz = hn::Mul(x, z);
  const Floats difference = hn::Sub(xx, yy), four_zz = times(4.0f, zz);
  const Floats twice_xy = hn::Add(xy, xy);
  const Floats steep = times(3.0f, difference);
  add(times(-0.59004358992664352f, weights[9]), times(6.0f, xy), steep, zero);
  add(times(2.8906114426405538f, weights[10]), yz, xz, xy);
  add(times(-0.45704579946446572f, weights[11]), hn::Neg(twice_xy),
      hn::Sub(hn::Sub(four_zz, xx), times(3.0f, yy)), times(8.0f, yz));
  add(times(1.11952899777034638f, weights[12]), times(-2.0f, xz), times(-2.0f, yz),
      hn::Sub(hn::Add(zz, zz), hn::Add(xx, yy)));
  add(times(-0.45704579946446572f, weights[13]), hn::Sub(hn::Sub(four_zz, yy), times(3.0f, xx)),
      hn::Neg(twice_xy), times(8.0f, xz));
  add(times(1.4453057213202769f, weights[14]), hn::Add(xz, xz), times(-2.0f, yz), difference);
  add(times(-0.59004358992664352f, weights[15]), steep, times(-6.0f, xy), zero);
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
