#include "trainer/splats/gaussian_step_kernels.hpp"

#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trainer/splats/gaussian_step_kernels.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "splatting/rotation-inl.hpp"
#include "trainer/splats/color_gradient-inl.hpp"
#include "trainer/splats/splat_adam-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::trainer::HWY_NAMESPACE {

using namespace splatting::HWY_NAMESPACE;
using shared::exp_of;
using shared::is_moderate;
using splatting::ImageView;
using splatting::ParameterRows;
using splatting::row_alignment;
namespace row = splatting::gaussian_row;

/// A matrix, row by row, transposed, times a vector.
HWY_INLINE Vector3 transposed_product(const float* m, const Vector3& v) {
  const auto column = [&](int i) {
    return dot({constant(m[i]), constant(m[i + 3]), constant(m[i + 6])}, v);
  };
  return {column(0), column(1), column(2)};
}

HWY_INLINE Vector3 sum(const Vector3& a, const Vector3& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}

/// GaussianMoments of a vector of splats.
struct Moments {
  Floats one, x, y, xx, xy, yy, red, green, blue, evident;
  Mask drawn;  // whether the splats have pairs
};

/// Adds the pairs of each splat in their order.
HWY_INLINE Moments moments_of(const GaussianBackwardInput& input, std::size_t i) {
  constexpr std::size_t values = sizeof(GaussianMoments) / sizeof(float);
  alignas(64) float sums[values][lanes] = {};
  alignas(64) float drawn[lanes] = {};
  for (std::size_t lane = 0; lane < lanes && i + lane < input.pairs.size(); ++lane) {
    const PairSpan range = input.pairs[i + lane];
    if (range.begin == range.end) continue;
    drawn[lane] = 1;
    GaussianMoments total = input.moments[range.begin];
    for (std::uint32_t pair = range.begin + 1; pair < range.end; ++pair) {
      const GaussianMoments& each = input.moments[pair];
      total.one += each.one;
      total.x += each.x;
      total.y += each.y;
      total.xx += each.xx;
      total.xy += each.xy;
      total.yy += each.yy;
      total.red += each.red;
      total.green += each.green;
      total.blue += each.blue;
      total.evident += each.evident;
    }
    const float of[values] = {total.one, total.x,   total.y,     total.xx,   total.xy,
                              total.yy,  total.red, total.green, total.blue, total.evident};
    for (std::size_t k = 0; k < values; ++k) sums[k][lane] = of[k];
  }
  const auto load = [&](std::size_t k) { return hn::Load(d, sums[k]); };
  return {load(0),
          load(1),
          load(2),
          load(3),
          load(4),
          load(5),
          load(6),
          load(7),
          load(8),
          load(9),
          hn::Gt(hn::Load(d, drawn), hn::Zero(d))};
}

/// The derivatives of a vector of splats.
struct Gradient {
  Floats values[row::harmonics];
  shared::ColorGradient color;
  Floats motion;  // the length of the derivative by the image of the centre
};

/// The derivative by a quaternion of any length, from those by the axes of its rotation. `x` to `w`
/// is the quaternion with length 1.
HWY_INLINE void rotation_gradient(const Vector3 (&axes)[3], Floats x, Floats y, Floats z, Floats w,
                                  Floats inverse_length, Floats* out) {
  const Vector3 &a = axes[0], &b = axes[1], &c = axes[2];
  const auto times = [](Floats factor, Floats value) { return hn::Mul(factor, value); };
  const Floats two = constant(2.0f);
  Floats by_w = times(z, hn::Sub(a.y, b.x));
  by_w = hn::MulAdd(y, hn::Sub(c.x, a.z), by_w);
  by_w = hn::MulAdd(x, hn::Sub(b.z, c.y), by_w);
  Floats by_x = times(y, hn::Add(a.y, b.x));
  by_x = hn::MulAdd(z, hn::Add(a.z, c.x), by_x);
  by_x = hn::MulAdd(w, hn::Sub(b.z, c.y), by_x);
  by_x = hn::NegMulAdd(hn::Mul(two, x), hn::Add(b.y, c.z), by_x);
  Floats by_y = times(x, hn::Add(a.y, b.x));
  by_y = hn::MulAdd(z, hn::Add(b.z, c.y), by_y);
  by_y = hn::MulAdd(w, hn::Sub(c.x, a.z), by_y);
  by_y = hn::NegMulAdd(hn::Mul(two, y), hn::Add(a.x, c.z), by_y);
  Floats by_z = times(x, hn::Add(a.z, c.x));
  by_z = hn::MulAdd(y, hn::Add(b.z, c.y), by_z);
  by_z = hn::MulAdd(w, hn::Sub(a.y, b.x), by_z);
  by_z = hn::NegMulAdd(hn::Mul(two, z), hn::Add(a.x, b.y), by_z);
  const Floats radial =
      hn::MulAdd(by_x, x, hn::MulAdd(by_y, y, hn::MulAdd(by_z, z, hn::Mul(by_w, w))));
  const Floats scale = hn::Mul(two, inverse_length);
  out[0] = times(scale, hn::NegMulAdd(radial, x, by_x));
  out[1] = times(scale, hn::NegMulAdd(radial, y, by_y));
  out[2] = times(scale, hn::NegMulAdd(radial, z, by_z));
  out[3] = times(scale, hn::NegMulAdd(radial, w, by_w));
}

/// Through the projection of splatting/gaussian_kernels.cpp. With the covariance S of the image and
/// the moments about the centre, dL/d(centre) = S^-1 (x, y) and dL/dS = S^-1 M S^-1 / 2.
HWY_INLINE void gradient_of(const GaussianBackwardInput& input,
                            const GaussianParameters& parameters, std::size_t i,
                            const Moments& moments, Gradient& gradient) {
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
  const Floats by_x = hn::MulAdd(l_xx, moments.x, hn::Mul(l_xy, moments.y));
  const Floats by_y = hn::MulAdd(l_xy, moments.x, hn::Mul(l_yy, moments.y));
  gradient.motion = hn::Sqrt(hn::MulAdd(by_x, by_x, hn::Mul(by_y, by_y)));
  const Floats a_xx = hn::MulAdd(moments.xx, l_xx, hn::Mul(moments.xy, l_xy));
  const Floats a_xy = hn::MulAdd(moments.xx, l_xy, hn::Mul(moments.xy, l_yy));
  const Floats a_yx = hn::MulAdd(moments.xy, l_xx, hn::Mul(moments.yy, l_xy));
  const Floats a_yy = hn::MulAdd(moments.xy, l_xy, hn::Mul(moments.yy, l_yy));
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
  const Floats qx = hn::Load(d, parameters.trained(row::rotation_x) + i),
               qy = hn::Load(d, parameters.trained(row::rotation_y) + i),
               qz = hn::Load(d, parameters.trained(row::rotation_z) + i),
               qw = hn::Load(d, parameters.trained(row::rotation_w) + i);
  const Floats length =
      hn::Sqrt(hn::MulAdd(qx, qx, hn::MulAdd(qy, qy, hn::MulAdd(qz, qz, hn::Mul(qw, qw)))));
  rotation_gradient(by_axes, rx, ry, rz, rw, hn::Div(one, length),
                    gradient.values + row::rotation_x);

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
  gradient.color =
      shared::color_gradient_of(input.degree, drawn.row(row::harmonics), drawn.stride(), i, offset,
                                {moments.red, moments.green, moments.blue});
  const Vector3 by_offset =
      sum(transposed_product(view.view_from_layer, by_center), gradient.color.by_offset);
  gradient.values[row::x] = by_offset.x;
  gradient.values[row::y] = by_offset.y;
  gradient.values[row::z] = by_offset.z;
  gradient.values[row::opacity] = hn::Mul(moments.one, hn::Sub(one, load(row::opacity)));
}

/// Calls act(row, derivative) for each row up to the drawn degree.
template <class Act>
HWY_INLINE void for_each_row(const Gradient& gradient, int degree, const Act& act) {
  for (std::size_t r = 0; r < row::harmonics; ++r) act(r, gradient.values[r]);
  const int count = (degree + 1) * (degree + 1);
  for (int k = 0; k < count; ++k) {
    const std::size_t first = row::harmonics + 3 * std::size_t(k);
    act(first, hn::Mul(gradient.color.basis[k], gradient.color.color.x));
    act(first + 1, hn::Mul(gradient.color.basis[k], gradient.color.color.y));
    act(first + 2, hn::Mul(gradient.color.basis[k], gradient.color.color.z));
  }
}

void gradients_on(const GaussianBackwardInput& input, const GaussianParameters& parameters,
                  std::size_t begin, std::size_t end, ParameterRows& gradients) {
  for (std::size_t i = begin; i < end; i += lanes) {
    const Moments moments = moments_of(input, i);
    Gradient gradient;
    gradient_of(input, parameters, i, moments, gradient);
    for_each_row(gradient, input.degree, [&](std::size_t r, Floats value) {
      hn::Store(hn::IfThenElseZero(moments.drawn, value), d, gradients.row(r) + i);
    });
  }
}

HWY_INLINE Mask can_step(const Gradient& gradient) {
  const Vector3& color = gradient.color.color;
  Mask result = hn::And(is_moderate(color.x), hn::And(is_moderate(color.y), is_moderate(color.z)));
  for (const Floats& value : gradient.values) result = hn::And(result, is_moderate(value));
  return result;
}

/// Limits the trained values, and computes the drawn ones.
HWY_INLINE void activate(const GaussianStep& step, std::size_t i, GaussianParameters& parameters) {
  const auto trained = [&](std::size_t r) { return parameters.trained(r) + i; };
  const auto store = [&](std::size_t r, Floats value) {
    hn::Store(value, d, parameters.drawn.row(r) + i);
  };
  const Floats one = constant(1.0f);
  for (std::size_t k = row::scale_x; k <= row::scale_z; ++k) {
    const Floats value = hn::Clamp(hn::Load(d, trained(k)), constant(step.min_log_scale),
                                   constant(step.max_log_scale));
    hn::Store(value, d, trained(k));
    store(k, exp_of(value));
  }
  Floats rotation[4], squared = hn::Zero(d);
  for (std::size_t k = 0; k < 4; ++k) {
    rotation[k] = hn::Load(d, trained(row::rotation_x + k));
    squared = hn::MulAdd(rotation[k], rotation[k], squared);
  }
  const Floats inverse = hn::Div(one, hn::Sqrt(squared));
  for (std::size_t k = 0; k < 4; ++k) store(row::rotation_x + k, hn::Mul(rotation[k], inverse));
  // Beyond 16, the sigmoid is 1 in single precision, and its derivative 0.
  const Floats logit =
      hn::Clamp(hn::Load(d, trained(row::opacity)), constant(-16.0f), constant(16.0f));
  hn::Store(logit, d, trained(row::opacity));
  store(row::opacity, hn::Div(one, hn::Add(one, exp_of(hn::Neg(logit)))));
}

/// The index in gaussian_parameter_kinds.
std::size_t kind_of(std::size_t r) {
  std::size_t kind = 0;
  while (r >= gaussian_parameter_kinds[kind].first + gaussian_parameter_kinds[kind].size) ++kind;
  return kind;
}

std::size_t step_on(const GaussianBackwardInput& input, const GaussianStep& step, std::size_t begin,
                    std::size_t end, GaussianParameters& parameters, SplatMemory& memory) {
  namespace statistic = splat_statistic;
  const std::size_t rows = parameters.rows();
  float rates[row::harmonics + 3 * 16];
  for (std::size_t r = 0; r < rows; ++r) rates[r] = step.rates[kind_of(r)];
  std::size_t quarantined = 0;
  for (std::size_t i = begin; i < end; i += lanes) {
    // More rows than the processor recognises as streams. Two blocks ahead.
    if (i + 3 * row_alignment <= parameters.drawn.stride() && i % row_alignment == 0)
      for (std::size_t r = 0; r < rows; ++r)
        hwy::Prefetch(parameters.trained(r) + i + 2 * row_alignment);
    const Moments moments = moments_of(input, i);
    if (hn::AllFalse(d, moments.drawn)) continue;
    Gradient gradient;
    gradient_of(input, parameters, i, moments, gradient);
    const Mask steps = hn::And(moments.drawn, can_step(gradient));
    quarantined += hn::CountTrue(d, hn::AndNot(steps, moments.drawn));
    const auto add = [&](std::size_t which, Floats value) {
      float* at = memory.statistics.row(which) + i;
      const Floats sum = hn::Add(hn::Load(d, at), hn::IfThenElseZero(steps, value));
      hn::Store(sum, d, at);
      return sum;
    };
    const Floats one = constant(1.0f);
    const Floats t = hn::Max(add(statistic::steps, one), one);
    add(statistic::motion, gradient.motion);
    add(statistic::evident, moments.evident);
    const shared::AdamOfSplats adam(step.adam, t, steps);
    SplatMemory::Line* block = memory.lines_of(i);
    for_each_row(gradient, input.degree, [&](std::size_t r, Floats value) {
      adam(rates[r], value, parameters.trained(r) + i, block[2 * r].values + i % row_alignment);
    });
    activate(step, i, parameters);
  }
  return quarantined;
}

}  // namespace tureen::trainer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tureen::trainer {

HWY_EXPORT(gradients_on);
HWY_EXPORT(step_on);

void gaussian_gradients(const GaussianBackwardInput& input, const GaussianParameters& parameters,
                        std::size_t begin, std::size_t end, splatting::ParameterRows& gradients) {
  HWY_DYNAMIC_DISPATCH(gradients_on)(input, parameters, begin, end, gradients);
}

std::size_t step_gaussians(const GaussianBackwardInput& input, const GaussianStep& step,
                           std::size_t begin, std::size_t end, GaussianParameters& parameters,
                           SplatMemory& memory) {
  return HWY_DYNAMIC_DISPATCH(step_on)(input, step, begin, end, parameters, memory);
}

}  // namespace tureen::trainer
#endif
