// The step of Gaussians and discs, which have the same parameters. Included once for each target of
// Highway.
#if defined(TUREEN_GAUSSIAN_STEP_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TUREEN_GAUSSIAN_STEP_INL
#undef TUREEN_GAUSSIAN_STEP_INL
#else
#define TUREEN_GAUSSIAN_STEP_INL
#endif

#include "splatting/rotation-inl.hpp"
#include "trainer/splats/gaussians/gaussian_step_kernels.hpp"
#include "trainer/splats/pair_sums-inl.hpp"
#include "trainer/splats/splat_step-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::trainer::HWY_NAMESPACE {
namespace gaussians {

using namespace splatting::HWY_NAMESPACE;
using shared::exp_of;
using splatting::ImageView;
using splatting::ParameterRows;
namespace row = splatting::gaussian_row;

using Gradient = shared::SplatGradient<row::harmonics>;

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

/// Limits the trained values, and computes the drawn ones.
HWY_INLINE void activate(const GaussianStep& step, std::size_t i, GaussianParameters& parameters) {
  shared::activate_lengths<row::scale_x>(step.min_log_scale, step.max_log_scale, i, parameters);
  shared::activate_rotation<row::rotation_x>(i, parameters);
  const Floats one = constant(1.0f);
  float* trained = parameters.trained(row::opacity) + i;
  // Beyond 16, the sigmoid is 1 in single precision, and its derivative 0.
  const Floats logit = hn::Clamp(hn::Load(d, trained), constant(-16.0f), constant(16.0f));
  hn::Store(logit, d, trained);
  hn::Store(hn::Div(one, hn::Add(one, exp_of(hn::Neg(logit)))), d,
            parameters.drawn.row(row::opacity) + i);
}

/// What write_gradients() and step_splats() need, without Moments and gradient_of().
struct GaussianLoops {
  using Step = GaussianStep;
  using Parameters = GaussianParameters;
  static constexpr const auto& kinds = gaussian_parameter_kinds;
  static HWY_INLINE void activate(const Step& step, std::size_t i, Parameters& parameters) {
    gaussians::activate(step, i, parameters);
  }
};

}  // namespace gaussians
}  // namespace tureen::trainer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
