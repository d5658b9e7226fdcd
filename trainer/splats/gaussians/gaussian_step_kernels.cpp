#include "trainer/splats/gaussians/gaussian_step_kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trainer/splats/gaussians/gaussian_step_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "trainer/splats/gaussians/gaussian_step-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::trainer::HWY_NAMESPACE {
namespace gaussians {

/// Through the projection of splatting/gaussians/gaussian_kernels.cpp. With the covariance S of the
/// image and the moments about the centre, dL/d(centre) = S^-1 (x, y) and dL/dS = S^-1 M S^-1 / 2.
HWY_INLINE Gradient gradient_of(const BackwardInput<GaussianMoments>& input,
                                const GaussianParameters& parameters, std::size_t i) {
  Gradient gradient;
  const auto sums = shared::pair_sums(input.pairs, input.moments, i);
  const auto& [one_sum, x_sum, y_sum, xx_sum, xy_sum, yy_sum, red, green, blue, evident] =
      sums.values;
  gradient.drawn = sums.drawn;
  gradient.evident = evident;
  if (hn::AllFalse(d, sums.drawn)) return gradient;
  const ImageView& view = input.view;
  const ParameterRows& drawn = parameters.drawn;
  const auto load = [&](std::size_t r) { return hn::Load(d, drawn.row(r) + i); };
  const Floats zero = hn::Zero(d), one = constant(1.0f);
  const Vector3 offset = from_eye(view, {load(row::x), load(row::y), load(row::z)});
  const Vector3 center = product(view.view_from_layer, offset);
  const Floats rx = load(row::rotation_x), ry = load(row::rotation_y), rz = load(row::rotation_z),
               rw = load(row::rotation_w);
  const Rotation rotation = rotation_of(rx, ry, rz, rw);
  const Floats by_depth = hn::Div(one, center.z);
  const Floats slope_x = hn::Mul(center.x, by_depth), slope_y = hn::Mul(center.y, by_depth);
  const auto clamped = [&](Floats value, int axis) {
    return hn::Clamp(value, constant(view.slope_low[axis]), constant(view.slope_high[axis]));
  };
  const Floats along_x = clamped(slope_x, 0), along_y = clamped(slope_y, 1);
  const Floats focal_x = hn::Mul(constant(view.fx), by_depth);
  const Floats focal_y = hn::Mul(constant(view.fy), by_depth);

  // The covariance, and its inverse.
  Vector3 axes[3];
  Floats x[3], y[3], to_x[3], to_y[3];  // rows; scale times focal length over depth
  for (std::size_t k = 0; k < 3; ++k) {
    axes[k] = product(view.view_from_layer, rotation.axes[k]);
    const Floats scale = load(row::scale_x + k);
    to_x[k] = hn::Mul(scale, focal_x);
    to_y[k] = hn::Mul(scale, focal_y);
    x[k] = hn::Mul(hn::NegMulAdd(along_x, axes[k].z, axes[k].x), to_x[k]);
    y[k] = hn::Mul(hn::NegMulAdd(along_y, axes[k].z, axes[k].y), to_y[k]);
  }
  const Vector3 row_x{x[0], x[1], x[2]}, row_y{y[0], y[1], y[2]};
  Floats xx = dot(row_x, row_x), yy = dot(row_y, row_y);
  const Floats xy = dot(row_x, row_y);
  const Vector3 normal = cross(row_x, row_y);
  const Floats dilation = constant(view.dilation);
  const Floats determinant =
      hn::MulAdd(dilation, hn::Add(hn::Add(xx, yy), dilation), dot(normal, normal));
  xx = hn::Add(xx, dilation);
  yy = hn::Add(yy, dilation);
  const Floats by_determinant = hn::Div(one, determinant);
  const Floats l_xx = hn::Mul(yy, by_determinant), l_yy = hn::Mul(xx, by_determinant);
  const Floats l_xy = hn::Neg(hn::Mul(xy, by_determinant));

  // Derivatives by the image of the centre, and twice those by the covariance.
  const Floats by_x = hn::MulAdd(l_xx, x_sum, hn::Mul(l_xy, y_sum));
  const Floats by_y = hn::MulAdd(l_xy, x_sum, hn::Mul(l_yy, y_sum));
  gradient.motion = hn::Sqrt(hn::MulAdd(by_x, by_x, hn::Mul(by_y, by_y)));
  const Floats a_xx = hn::MulAdd(xx_sum, l_xx, hn::Mul(xy_sum, l_xy));
  const Floats a_xy = hn::MulAdd(xx_sum, l_xy, hn::Mul(xy_sum, l_yy));
  const Floats a_yx = hn::MulAdd(xy_sum, l_xx, hn::Mul(yy_sum, l_xy));
  const Floats a_yy = hn::MulAdd(xy_sum, l_xy, hn::Mul(yy_sum, l_yy));
  const Floats w_xx = hn::MulAdd(l_xx, a_xx, hn::Mul(l_xy, a_yx));
  const Floats w_xy = hn::MulAdd(l_xx, a_xy, hn::Mul(l_xy, a_yy));
  const Floats w_yy = hn::MulAdd(l_xy, a_xy, hn::Mul(l_yy, a_yy));

  // By the axes, the scales, the slopes and the focal lengths over the depth.
  Vector3 by_axes[3];
  Floats by_along_x = zero, by_along_y = zero, by_size = zero;
  for (std::size_t k = 0; k < 3; ++k) {
    const Floats by_row_x = hn::MulAdd(w_xx, x[k], hn::Mul(w_xy, y[k]));
    const Floats by_row_y = hn::MulAdd(w_xy, x[k], hn::Mul(w_yy, y[k]));
    const Floats by_scale = hn::MulAdd(by_row_x, x[k], hn::Mul(by_row_y, y[k]));
    gradient.values[row::scale_x + k] = by_scale;
    by_size = hn::Add(by_size, by_scale);
    const Floats axis_x = hn::Mul(by_row_x, to_x[k]), axis_y = hn::Mul(by_row_y, to_y[k]);
    by_along_x = hn::NegMulAdd(axis_x, axes[k].z, by_along_x);
    by_along_y = hn::NegMulAdd(axis_y, axes[k].z, by_along_y);
    const Floats axis_z = hn::Neg(hn::MulAdd(axis_x, along_x, hn::Mul(axis_y, along_y)));
    by_axes[k] = transposed_product(view.view_from_layer, {axis_x, axis_y, axis_z});
  }
  rotation_gradient(by_axes, parameters, i, gradient);

  // By the centre: its image, the slopes in the Jacobian where they are not limited, the depth in
  // the focal lengths, and the direction of the colour.
  const Mask free_x = hn::Eq(along_x, slope_x), free_y = hn::Eq(along_y, slope_y);
  const Floats by_slope_x =
      hn::MulAdd(constant(view.fx), by_x, hn::IfThenElseZero(free_x, by_along_x));
  const Floats by_slope_y =
      hn::MulAdd(constant(view.fy), by_y, hn::IfThenElseZero(free_y, by_along_y));
  const Floats by_z =
      hn::Neg(hn::MulAdd(by_slope_x, slope_x, hn::MulAdd(by_slope_y, slope_y, by_size)));
  const Vector3 by_center{hn::Mul(by_slope_x, by_depth), hn::Mul(by_slope_y, by_depth),
                          hn::Mul(by_z, by_depth)};
  gradient.color = shared::color_gradient_of(input.degree, drawn.row(row::harmonics),
                                             drawn.stride(), i, offset, {red, green, blue});
  const Vector3 by_offset =
      sum(transposed_product(view.view_from_layer, by_center), gradient.color.by_offset);
  gradient.values[row::x] = by_offset.x;
  gradient.values[row::y] = by_offset.y;
  gradient.values[row::z] = by_offset.z;
  gradient.values[row::opacity] = hn::Mul(one_sum, hn::Sub(one, load(row::opacity)));
  return gradient;
}

struct RoundLoops : GaussianLoops {
  using Moments = GaussianMoments;
  static HWY_INLINE Gradient gradient_of(const BackwardInput<Moments>& input, const Step&,
                                         const Parameters& parameters, std::size_t i) {
    return gaussians::gradient_of(input, parameters, i);
  }
};

const StepFunctions<GaussianMoments, GaussianStep, GaussianParameters>&
gaussian_step_functions_on() {
  return shared::step_functions<RoundLoops>;
}

}  // namespace gaussians
using gaussians::gaussian_step_functions_on;
}  // namespace tureen::trainer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tureen::trainer {

HWY_EXPORT(gaussian_step_functions_on);

const StepFunctions<GaussianMoments, GaussianStep, GaussianParameters>& gaussian_step_functions() {
  return HWY_DYNAMIC_DISPATCH(gaussian_step_functions_on)();
}

}  // namespace tureen::trainer
#endif
