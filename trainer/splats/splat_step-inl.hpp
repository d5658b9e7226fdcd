// The step of splats of any kernel, from the derivatives of its parameters. Included once for each
// target of Highway.
#if defined(TUREEN_SPLAT_STEP_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TUREEN_SPLAT_STEP_INL
#undef TUREEN_SPLAT_STEP_INL
#else
#define TUREEN_SPLAT_STEP_INL
#endif

#include <hwy/cache_control.h>

#include <algorithm>
#include <cassert>

#include "trainer/splats/color_gradient-inl.hpp"
#include "trainer/splats/parameter_kinds.hpp"
#include "trainer/splats/splat_adam-inl.hpp"
#include "trainer/splats/splat_memory.hpp"
#include "trainer/splats/splat_step.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::trainer::HWY_NAMESPACE {
namespace shared {

/// The derivatives of a vector of splats. `first_harmonic`: the row of the first one, after all
/// other parameters.
template <std::size_t first_harmonic>
struct SplatGradient {
  Floats values[first_harmonic];
  ColorGradient color;
  Floats motion;   // the length of the derivative by the image of the splat
  Floats evident;  // > 0: some pixel has evident_weight
  Mask drawn;      // if none is, the others are not set
};

/// Calls act(row, derivative) for each row up to the drawn degree.
template <std::size_t first_harmonic, class Act>
HWY_INLINE void for_each_row(const SplatGradient<first_harmonic>& gradient, int degree,
                             const Act& act) {
  for (std::size_t r = 0; r < first_harmonic; ++r) act(r, gradient.values[r]);
  const int count = (degree + 1) * (degree + 1);
  const Vector3& color = gradient.color.color;
  for (int k = 0; k < count; ++k) {
    const std::size_t first = first_harmonic + 3 * std::size_t(k);
    act(first, hn::Mul(gradient.color.basis[k], color.x));
    act(first + 1, hn::Mul(gradient.color.basis[k], color.y));
    act(first + 2, hn::Mul(gradient.color.basis[k], color.z));
  }
}

/// StepFunctions::gradients. `Loops` has the types Moments, Step and Parameters, and
///   kinds                                     the table of parameters
///   gradient_of(input, step, parameters, i)   the derivatives of the splats from `i` on
///   activate(step, i, parameters)             limits their trained values, and computes the drawn
///                                             ones
template <class Loops>
void write_gradients(const BackwardInput<typename Loops::Moments>& input,
                     const typename Loops::Step& step, const typename Loops::Parameters& parameters,
                     std::size_t begin, std::size_t end, splatting::ParameterRows& gradients) {
  for (std::size_t r = 0; r < parameters.rows(); ++r)
    std::fill(gradients.row(r) + begin, gradients.row(r) + end, 0.0f);
  for (std::size_t i = begin; i < end; i += lanes) {
    const auto gradient = Loops::gradient_of(input, step, parameters, i);
    if (hn::AllFalse(d, gradient.drawn)) continue;
    for_each_row(gradient, input.degree, [&](std::size_t r, Floats value) {
      hn::Store(hn::IfThenElseZero(gradient.drawn, value), d, gradients.row(r) + i);
    });
  }
}

template <std::size_t first_harmonic>
HWY_INLINE Mask can_step(const SplatGradient<first_harmonic>& gradient) {
  const Vector3& color = gradient.color.color;
  Mask result = hn::And(is_moderate(color.x), hn::And(is_moderate(color.y), is_moderate(color.z)));
  for (const Floats& value : gradient.values) result = hn::And(result, is_moderate(value));
  return result;
}

/// StepFunctions::step, with `Loops` as above.
template <class Loops>
std::size_t step_splats(const BackwardInput<typename Loops::Moments>& input,
                        const typename Loops::Step& step, std::size_t begin, std::size_t end,
                        typename Loops::Parameters& parameters, SplatMemory& memory) {
  namespace statistic = splat_statistic;
  constexpr std::size_t block = SplatMemory::block;
  constexpr std::size_t max_rows = 112;  // neural densities of degree 3 have 99
  const std::size_t rows = parameters.rows();
  assert(rows <= max_rows);
  float rates[max_rows];
  const auto& kinds = Loops::kinds;
  for (std::size_t k = 0; k < kinds.size(); ++k)
    for (std::size_t r = kinds[k].first; r < std::min(kinds[k].first + kinds[k].size, rows); ++r)
      rates[r] = step.rates[k];
  std::size_t quarantined = 0;
  for (std::size_t i = begin; i < end; i += lanes) {
    // More rows than the processor recognises as streams. Two blocks ahead.
    if (i + 3 * block <= parameters.drawn.stride() && i % block == 0)
      for (std::size_t r = 0; r < rows; ++r) hwy::Prefetch(parameters.trained(r) + i + 2 * block);
    const auto gradient = Loops::gradient_of(input, step, parameters, i);
    if (hn::AllFalse(d, gradient.drawn)) continue;
    const Mask steps = hn::And(gradient.drawn, can_step(gradient));
    quarantined += hn::CountTrue(d, hn::AndNot(steps, gradient.drawn));
    const auto add = [&](std::size_t which, Floats value) {
      float* at = memory.statistics.row(which) + i;
      const Floats total = hn::Add(hn::Load(d, at), hn::IfThenElseZero(steps, value));
      hn::Store(total, d, at);
      return total;
    };
    const Floats one = constant(1.0f);
    const Floats steps_done = hn::Max(add(statistic::steps, one), one);
    add(statistic::motion, gradient.motion);
    add(statistic::evident, gradient.evident);
    const AdamOfSplats adam(step.adam, steps_done, steps);
    SplatMemory::Line* lines = memory.lines_of(i);
    for_each_row(gradient, input.degree, [&](std::size_t r, Floats value) {
      adam(rates[r], value, parameters.trained(r) + i, lines[2 * r].values + i % block);
    });
    Loops::activate(step, i, parameters);
  }
  return quarantined;
}

/// For Loops::activate: limits three trained logarithms of lengths, and computes the lengths.
template <std::size_t first, class Parameters>
HWY_INLINE void activate_lengths(float low, float high, std::size_t i, Parameters& parameters) {
  for (std::size_t k = first; k < first + 3; ++k) {
    float* trained = parameters.trained(k) + i;
    const Floats value = hn::Clamp(hn::Load(d, trained), constant(low), constant(high));
    hn::Store(value, d, trained);
    hn::Store(exp_of(value), d, parameters.drawn.row(k) + i);
  }
}

/// For Loops::activate: the drawn quaternion, of unit length.
template <std::size_t first, class Parameters>
HWY_INLINE void activate_rotation(std::size_t i, Parameters& parameters) {
  Floats rotation[4], squared = hn::Zero(d);
  for (std::size_t k = 0; k < 4; ++k) {
    rotation[k] = hn::Load(d, parameters.trained(first + k) + i);
    squared = hn::MulAdd(rotation[k], rotation[k], squared);
  }
  const Floats inverse = hn::Div(constant(1.0f), hn::Sqrt(squared));
  for (std::size_t k = 0; k < 4; ++k)
    hn::Store(hn::Mul(rotation[k], inverse), d, parameters.drawn.row(first + k) + i);
}

template <class Loops>
constexpr StepFunctions<typename Loops::Moments, typename Loops::Step, typename Loops::Parameters>
    step_functions{&write_gradients<Loops>, &step_splats<Loops>};

}  // namespace shared
}  // namespace tureen::trainer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
