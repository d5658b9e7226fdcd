#include "trainer/splats/discs/disc_step_kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trainer/splats/discs/disc_step_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "splatting/discs/disc_plane-inl.hpp"
#include "trainer/splats/gaussians/gaussian_step-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::trainer::HWY_NAMESPACE {
namespace discs {

using namespace gaussians;

/// Through the projection of splatting/discs/disc_kernels.cpp for discs with a centre in front of
/// the eye.
///
/// A line of DiscAt is k = H_x - dx H_w, where H_x = (u_x, v_x, 0) and H_w = (u_w, v_w, depth) are
/// rows of the projected disc; l is the same with y. With the sums Q, Q_x and Q_y of q, q dx and
/// q dy over the pixels (DiscMoments), the sums of dL/dk and dL/dl are
///   K = H_y x Q - H_w x Q_y,  L = H_w x Q_x - H_x x Q,
/// and that of dx dL/dk + dy dL/dl is M = H_y x Q_x - H_x x Q_y. The rows of the disc in view
/// coordinates, (U, V, C), have the derivatives f_x K, f_y L and -M - f_x s_x K - f_y s_y L, where
/// s_x and s_y are the slopes of the centre.
HWY_INLINE Gradient disc_gradient_of(const BackwardInput<DiscMoments>& input,
                                     const GaussianParameters& parameters, std::size_t i) {
  Gradient gradient;
  const auto sums = shared::sums_of_three(input.pairs, input.moments, i);
  gradient.drawn = sums.drawn;
  if (hn::AllFalse(d, sums.drawn)) return gradient;
  const Vector3 &q = sums.one, &q_x = sums.x, &q_y = sums.y;
  gradient.evident = sums.evident;

  const ImageView& view = input.view;
  const ParameterRows& drawn = parameters.drawn;
  const auto load = [&](std::size_t r) { return hn::Load(d, drawn.row(r) + i); };
  const Floats zero = hn::Zero(d), one = constant(1.0f);
  const Vector3 offset = from_eye(view, {load(row::x), load(row::y), load(row::z)});
  const Vector3 center = product(view.view_from_layer, offset);
  const Rotation rotation = rotation_of(load(row::rotation_x), load(row::rotation_y),
                                        load(row::rotation_z), load(row::rotation_w));
  const Floats by_depth = hn::Div(one, center.z);
  const Floats slope_x = hn::Mul(center.x, by_depth), slope_y = hn::Mul(center.y, by_depth);
  const Floats fx = constant(view.fx), fy = constant(view.fy);

  Vector3 axes[2];  // with a length of one deviation
  for (std::size_t k = 0; k < 2; ++k)
    axes[k] = product(product(view.view_from_layer, rotation.axes[k]), load(row::scale_x + k));
  const DiscPlane plane = plane_of(view, center, axes[0], axes[1], gradient.drawn);
  const Vector3 &h_x = plane.of_x, &h_y = plane.of_y, &h_w = plane.of_w;
  const Vector3 row_x = product(difference(cross(h_y, q), cross(h_w, q_y)), fx);
  const Vector3 row_y = product(difference(cross(h_w, q_x), cross(h_x, q)), fy);
  const Vector3 moment = difference(cross(h_x, q_y), cross(h_y, q_x));
  const Vector3 row_z = difference(moment, sum(product(row_x, slope_x), product(row_y, slope_y)));

  const Vector3 by_axes[2] = {{row_x.x, row_y.x, row_z.x}, {row_x.y, row_y.y, row_z.y}};
  Vector3 by_rotation[3] = {{}, {}, {zero, zero, zero}};
  for (std::size_t k = 0; k < 2; ++k) {
    gradient.values[row::scale_x + k] = dot(by_axes[k], axes[k]);
    by_rotation[k] =
        transposed_product(view.view_from_layer, product(by_axes[k], load(row::scale_x + k)));
  }
  gradient.values[row::scale_z] = zero;
  rotation_gradient(by_rotation, parameters, i, gradient);

  // By the image of the centre, in pixels: through the filter on the screen, and the plane.
  const Floats by_variance =
      constant(view.screen_variance > 0 ? 1.0f / view.screen_variance : 0.0f);
  const Floats screen_x = hn::Mul(hn::Mul(fx, by_variance), sums.others[0]);
  const Floats screen_y = hn::Mul(hn::Mul(fy, by_variance), sums.others[1]);
  const Vector3 by_center{
      hn::MulAdd(screen_x, by_depth, row_x.z), hn::MulAdd(screen_y, by_depth, row_y.z),
      hn::NegMulAdd(hn::MulAdd(screen_x, slope_x, hn::Mul(screen_y, slope_y)), by_depth, row_z.z)};
  const Floats image_x = hn::Div(hn::Mul(by_center.x, center.z), fx);
  const Floats image_y = hn::Div(hn::Mul(by_center.y, center.z), fy);
  gradient.motion = hn::Sqrt(hn::MulAdd(image_x, image_x, hn::Mul(image_y, image_y)));
  gradient.color = shared::color_gradient_of(input.degree, drawn.row(row::harmonics),
                                             drawn.stride(), i, offset, sums.color);
  const Vector3 by_offset =
      sum(transposed_product(view.view_from_layer, by_center), gradient.color.by_offset);
  gradient.values[row::x] = by_offset.x;
  gradient.values[row::y] = by_offset.y;
  gradient.values[row::z] = by_offset.z;
  gradient.values[row::opacity] = hn::Mul(sums.h, hn::Sub(one, load(row::opacity)));
  return gradient;
}

struct DiscLoops : GaussianLoops {
  using Moments = DiscMoments;
  static HWY_INLINE Gradient gradient_of(const BackwardInput<Moments>& input, const Step&,
                                         const Parameters& parameters, std::size_t i) {
    return disc_gradient_of(input, parameters, i);
  }
};

const StepFunctions<DiscMoments, GaussianStep, GaussianParameters>& disc_step_functions_on() {
  return shared::step_functions<DiscLoops>;
}

}  // namespace discs
using discs::disc_step_functions_on;
}  // namespace tureen::trainer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tureen::trainer {

HWY_EXPORT(disc_step_functions_on);

const StepFunctions<DiscMoments, GaussianStep, GaussianParameters>& disc_step_functions() {
  return HWY_DYNAMIC_DISPATCH(disc_step_functions_on)();
}

}  // namespace tureen::trainer
#endif
