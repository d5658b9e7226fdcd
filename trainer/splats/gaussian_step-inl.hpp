// The step of Gaussians and discs, which have the same parameters. Included once for each target of
// Highway.
#if defined(TUREEN_GAUSSIAN_STEP_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TUREEN_GAUSSIAN_STEP_INL
#undef TUREEN_GAUSSIAN_STEP_INL
#else
#define TUREEN_GAUSSIAN_STEP_INL
#endif

#include <hwy/cache_control.h>

#include <algorithm>

#include "splatting/rotation-inl.hpp"
#include "trainer/splats/color_gradient-inl.hpp"
#include "trainer/splats/gaussian_step_kernels.hpp"
#include "trainer/splats/pair_sums-inl.hpp"
#include "trainer/splats/splat_adam-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::trainer::HWY_NAMESPACE {
namespace gaussians {

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

/// The derivatives of a vector of splats.
struct Gradient {
  Floats values[row::harmonics];
  shared::ColorGradient color;
  Floats motion;  // the length of the derivative by the image of the centre
  Floats evident;
  Mask drawn;
};

/// The derivative by a quaternion of any length, from those by the axes of its rotation.
HWY_INLINE void rotation_gradient(const Vector3 (&axes)[3], const GaussianParameters& parameters,
                                  std::size_t i, Gradient& gradient) {
  const auto of = [&](std::size_t r) { return hn::Load(d, parameters.drawn.row(r) + i); };
  const Floats x = of(row::rotation_x), y = of(row::rotation_y), z = of(row::rotation_z),
               w = of(row::rotation_w);
  Floats squared = hn::Zero(d);
  for (std::size_t k = row::rotation_x; k <= row::rotation_w; ++k) {
    const Floats trained = hn::Load(d, parameters.trained(k) + i);
    squared = hn::MulAdd(trained, trained, squared);
  }
  Floats* out = gradient.values + row::rotation_x;
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
  const Floats scale = hn::Div(two, hn::Sqrt(squared));
  out[0] = times(scale, hn::NegMulAdd(radial, x, by_x));
  out[1] = times(scale, hn::NegMulAdd(radial, y, by_y));
  out[2] = times(scale, hn::NegMulAdd(radial, z, by_z));
  out[3] = times(scale, hn::NegMulAdd(radial, w, by_w));
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

/// Writes the derivatives by all rows. `gradient_of(input, parameters, i, gradient)` computes those
/// of the splats from `i` on, if any is drawn.
template <class BackwardInput, class GradientOf>
HWY_INLINE void gradients_by(const BackwardInput& input, const GaussianParameters& parameters,
                             std::size_t begin, std::size_t end, ParameterRows& gradients,
                             const GradientOf& gradient_of) {
  for (std::size_t r = 0; r < parameters.rows(); ++r)
    std::fill(gradients.row(r) + begin, gradients.row(r) + end, 0.0f);
  for (std::size_t i = begin; i < end; i += lanes) {
    Gradient gradient;
    gradient_of(input, parameters, i, gradient);
    if (hn::AllFalse(d, gradient.drawn)) continue;
    for_each_row(gradient, input.degree, [&](std::size_t r, Floats value) {
      hn::Store(hn::IfThenElseZero(gradient.drawn, value), d, gradients.row(r) + i);
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
HWY_INLINE std::size_t kind_of(std::size_t r) {
  std::size_t kind = 0;
  while (r >= gaussian_parameter_kinds[kind].first + gaussian_parameter_kinds[kind].size) ++kind;
  return kind;
}

/// A step by Adam of the drawn splats, and their statistics.
template <class BackwardInput, class GradientOf>
HWY_INLINE std::size_t step_by(const BackwardInput& input, const GaussianStep& step,
                               std::size_t begin, std::size_t end, GaussianParameters& parameters,
                               SplatMemory& memory, const GradientOf& gradient_of) {
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
    Gradient gradient;
    gradient_of(input, parameters, i, gradient);
    if (hn::AllFalse(d, gradient.drawn)) continue;
    const Mask steps = hn::And(gradient.drawn, can_step(gradient));
    quarantined += hn::CountTrue(d, hn::AndNot(steps, gradient.drawn));
    const auto add = [&](std::size_t which, Floats value) {
      float* at = memory.statistics.row(which) + i;
      const Floats sum = hn::Add(hn::Load(d, at), hn::IfThenElseZero(steps, value));
      hn::Store(sum, d, at);
      return sum;
    };
    const Floats one = constant(1.0f);
    const Floats t = hn::Max(add(statistic::steps, one), one);
    add(statistic::motion, gradient.motion);
    add(statistic::evident, gradient.evident);
    const shared::AdamOfSplats adam(step.adam, t, steps);
    SplatMemory::Line* block = memory.lines_of(i);
    for_each_row(gradient, input.degree, [&](std::size_t r, Floats value) {
      adam(rates[r], value, parameters.trained(r) + i, block[2 * r].values + i % row_alignment);
    });
    activate(step, i, parameters);
  }
  return quarantined;
}

}  // namespace gaussians
}  // namespace tureen::trainer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
