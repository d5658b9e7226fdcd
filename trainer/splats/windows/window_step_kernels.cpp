#include "trainer/splats/windows/window_step_kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trainer/splats/windows/window_step_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "splatting/windows/window_plane-inl.hpp"
#include "trainer/splats/pair_sums-inl.hpp"
#include "trainer/splats/splat_step-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::trainer::HWY_NAMESPACE {
namespace windows {

using namespace splatting::HWY_NAMESPACE;
using splatting::ImageView;
using splatting::ParameterRows;
namespace row = splatting::window_row;

using Gradient = shared::SplatGradient<row::harmonics>;

/// The derivatives by the lines of rho from those by the lines of rho_s (SolidRamp).
HWY_INLINE void through_ramp(const SolidRamp& ramp, const WindowPlane& plane,
                             Vector3 (&by_edge)[3]) {
  Floats by_gain = hn::Zero(d);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3 edge{plane.edges[3 * k], plane.edges[3 * k + 1], plane.edges[3 * k + 2]};
    by_gain = hn::Add(by_gain, dot(edge, by_edge[k]));
    by_edge[k] = product(by_edge[k], ramp.gain);
  }
  const Floats factor = hn::Div(hn::Mul(by_gain, ramp.gain_slope), ramp.by_inradius);
  by_edge[0].x = hn::MulAdd(factor, plane.edges[0], by_edge[0].x);
  by_edge[0].y = hn::MulAdd(factor, plane.edges[1], by_edge[0].y);
}

/// The derivatives by the homogeneous image points Q_k of the corners, in the unit of
/// WindowCorners, from those by the three lines e_k.
///
/// e_k = W N_k / (det l_k) with N_k = Q_i x Q_j, l_k = |N_k.xy|, W = sum_k w_k l_k and det =
/// Q_0 . N_0 (splatting/windows/window_plane-inl.hpp). With s_k = e_k . dL/d(e_k) and S = sum_k
/// s_k,
///   dL/dN_k = (W / (det l_k)) dL/d(e_k) + (S w_k / W - s_k / l_k) (N_k.xy, 0) / l_k,
///   dL/dw_k = S l_k / W and dL/dQ_k = -S N_k / det beside those through N.
/// The image of the centre is the origin here, and a constant: the lines do not depend on it.
HWY_INLINE void corner_gradient(const WindowCorners& at, const WindowPlane& plane,
                                const Vector3 (&by_edge)[3], Vector3 (&by_point)[3]) {
  const Floats one = constant(1.0f);
  const Floats by_weight = hn::Div(one, plane.weight), by_det = hn::Div(one, plane.determinant);
  Floats s[3], total = hn::Zero(d);
  for (std::size_t k = 0; k < 3; ++k) {
    s[k] = dot({plane.edges[3 * k], plane.edges[3 * k + 1], plane.edges[3 * k + 2]}, by_edge[k]);
    total = hn::Add(total, s[k]);
  }
  const Floats total_by_weight = hn::Mul(total, by_weight);
  const Floats total_by_det = hn::Neg(hn::Mul(total, by_det));
  const Floats weight_by_det = hn::Mul(plane.weight, by_det);
  Vector3 by_normal[3], point[3];
  for (std::size_t k = 0; k < 3; ++k) {
    const Floats by_length = hn::Div(one, plane.length[k]);
    by_normal[k] = product(by_edge[k], hn::Mul(weight_by_det, by_length));
    const Floats along =
        hn::Mul(by_length, hn::MulSub(total_by_weight, at.point[k].z, hn::Mul(s[k], by_length)));
    by_normal[k].x = hn::MulAdd(along, plane.normal_x[k], by_normal[k].x);
    by_normal[k].y = hn::MulAdd(along, plane.normal_y[k], by_normal[k].y);
    point[k] = {hn::NegMulAdd(at.x, at.point[k].z, at.point[k].x),
                hn::NegMulAdd(at.y, at.point[k].z, at.point[k].y), at.point[k].z};
    by_point[k] =
        product({plane.normal_x[k], plane.normal_y[k], plane.at_reference[k]}, total_by_det);
    by_point[k].z = hn::MulAdd(total_by_weight, plane.length[k], by_point[k].z);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t from = (k + 1) % 3, to = (k + 2) % 3;
    by_point[from] = sum(by_point[from], cross(point[to], by_normal[k]));
    by_point[to] = sum(by_point[to], cross(by_normal[k], point[from]));
  }
  // From the point relative to the centre's image to the point.
  for (std::size_t k = 0; k < 3; ++k)
    by_point[k].z =
        hn::NegMulAdd(at.x, by_point[k].x, hn::NegMulAdd(at.y, by_point[k].y, by_point[k].z));
}

/// The derivatives of 1 / area by the corners; both in the same unit.
HWY_INLINE void inverse_area_gradient(const Vector3 (&corner)[3], Vector3 (&by_corner)[3]) {
  const Vector3 edges[3] = {difference(corner[2], corner[1]), difference(corner[0], corner[2]),
                            difference(corner[1], corner[0])};
  const Vector3 normal = cross(edges[0], edges[1]);  // twice the area
  const Floats squared = dot(normal, normal);
  // d(2 / |n|) = -2 n . dn / |n|^3, and n . dn = (edge x n) . d(corner opposite).
  const Floats factor = hn::Div(constant(-2.0f), hn::Mul(squared, hn::Sqrt(squared)));
  for (std::size_t k = 0; k < 3; ++k) by_corner[k] = product(cross(normal, edges[k]), factor);
}

HWY_INLINE Gradient gradient_of(const BackwardInput<WindowMoments>& input, const WindowLoss& loss,
                                const WindowParameters& parameters, std::size_t i) {
  const shared::SumsOfThree moments = shared::sums_of_three(input.pairs, input.moments, i);
  Gradient gradient;
  gradient.drawn = moments.drawn;
  gradient.evident = moments.evident;
  if (hn::AllFalse(d, moments.drawn)) return gradient;
  const ImageView& view = input.view;
  const ParameterRows& drawn = parameters.drawn;
  const auto load = [&](std::size_t r) { return hn::Load(d, drawn.row(r) + i); };
  const Floats one = constant(1.0f);
  Vector3 corner[3];
  for (std::size_t k = 0; k < 3; ++k)
    corner[k] = {load(row::corners + 3 * k), load(row::corners + 3 * k + 1),
                 load(row::corners + 3 * k + 2)};
  const WindowCorners at = corners_of(view, corner);
  const WindowPlane plane = plane_of(view, at);
  const Floats sigma = load(row::sigma), opacity = load(row::opacity);
  Vector3 by_edge[3], by_point[3];
  const auto &one_sum = moments.one, &x = moments.x, &y = moments.y;
  by_edge[0] = product({x.x, y.x, one_sum.x}, sigma);
  by_edge[1] = product({x.y, y.y, one_sum.y}, sigma);
  by_edge[2] = product({x.z, y.z, one_sum.z}, sigma);
  if (view.solidity > 0) through_ramp(SolidRamp(view, plane), plane, by_edge);
  corner_gradient(at, plane, by_edge, by_point);
  gradient.color = shared::color_gradient_of(input.degree, drawn.row(row::harmonics),
                                             drawn.stride(), i, at.center, moments.color);
  const Vector3 by_center = product(gradient.color.by_offset, constant(1.0f / 3.0f));
  Vector3 by_area[3];
  if (loss.inverse_area > 0) inverse_area_gradient(at.corner, by_area);
  gradient.motion = hn::Zero(d);
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3& p = by_point[k];
    gradient.motion = hn::MulAdd(
        hn::Abs(at.point[k].z), hn::Sqrt(hn::MulAdd(p.x, p.x, hn::Mul(p.y, p.y))), gradient.motion);
    const Vector3 in_view{hn::Mul(p.x, constant(view.fx)), hn::Mul(p.y, constant(view.fy)), p.z};
    Vector3 by_corner =
        product(sum(transposed_product(view.view_from_layer, in_view), by_center), at.by_size);
    if (loss.inverse_area > 0) {
      const Floats squared = hn::Mul(at.by_size, at.by_size);
      const Floats factor = hn::Mul(constant(loss.inverse_area), hn::Mul(squared, at.by_size));
      by_corner = sum(by_corner, product(by_area[k], factor));
    }
    gradient.values[row::corners + 3 * k] = by_corner.x;
    gradient.values[row::corners + 3 * k + 1] = by_corner.y;
    gradient.values[row::corners + 3 * k + 2] = by_corner.z;
  }
  // ln(alpha) = .. + sigma ln(rho), and d sigma = (sigma - floor) d(log).
  const Floats by_sigma =
      hn::MulAdd(moments.others[0], constant(0.693147181f), constant(loss.sigma));
  gradient.values[row::sigma] = hn::Mul(by_sigma, hn::Sub(sigma, constant(sigma_floor)));
  // With o = s + (1 - s) sigmoid(logit): d o = (o - s) (1 - o) / (1 - s) d(logit).
  const float low = parameters.solidity;
  const Floats by_logit = hn::Mul(hn::Mul(hn::Sub(opacity, constant(low)), hn::Sub(one, opacity)),
                                  constant(1 / (1 - low)));
  gradient.values[row::opacity] =
      hn::Mul(hn::Add(hn::Div(moments.h, opacity), constant(loss.opacity)), by_logit);
  return gradient;
}

/// Limits the trained values, and computes the drawn ones.
HWY_INLINE void activate(std::size_t i, WindowParameters& parameters) {
  const auto limited = [&](std::size_t r, float low, float high) {
    float* at = parameters.trained(r) + i;
    const Floats value = hn::Clamp(hn::Load(d, at), constant(low), constant(high));
    hn::Store(value, d, at);
    return value;
  };
  const Floats one = constant(1.0f);
  const Floats sigma = hn::Add(shared::exp_of(limited(row::sigma, min_log_sigma, max_log_sigma)),
                               constant(sigma_floor));
  hn::Store(sigma, d, parameters.drawn.row(row::sigma) + i);
  const Floats logit = limited(row::opacity, -max_logit, max_logit);
  const Floats fraction = hn::Div(one, hn::Add(one, shared::exp_of(hn::Neg(logit))));
  const float low = parameters.solidity;
  hn::Store(hn::MulAdd(fraction, constant(1 - low), constant(low)), d,
            parameters.drawn.row(row::opacity) + i);
}

struct WindowStepLoops {
  using Moments = WindowMoments;
  using Step = WindowStep;
  using Parameters = WindowParameters;
  static constexpr const auto& kinds = window_parameter_kinds;
  static HWY_INLINE Gradient gradient_of(const BackwardInput<Moments>& input, const Step& step,
                                         const Parameters& parameters, std::size_t i) {
    return windows::gradient_of(input, step.loss, parameters, i);
  }
  static HWY_INLINE void activate(const Step&, std::size_t i, Parameters& parameters) {
    windows::activate(i, parameters);
  }
};

const StepFunctions<WindowMoments, WindowStep, WindowParameters>& window_step_functions_on() {
  return shared::step_functions<WindowStepLoops>;
}

}  // namespace windows
using windows::window_step_functions_on;
}  // namespace tureen::trainer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tureen::trainer {

HWY_EXPORT(window_step_functions_on);

const StepFunctions<WindowMoments, WindowStep, WindowParameters>& window_step_functions() {
  return HWY_DYNAMIC_DISPATCH(window_step_functions_on)();
}

}  // namespace tureen::trainer
#endif
