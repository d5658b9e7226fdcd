#include "trainer/splats/neural/neural_step_kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trainer/splats/neural/neural_step_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "splatting/rotation-inl.hpp"
#include "trainer/splats/pair_sums-inl.hpp"
#include "trainer/splats/splat_step-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::trainer::HWY_NAMESPACE {
namespace densities {

using namespace splatting::HWY_NAMESPACE;
using splatting::ImageView;
using splatting::neurons;
using splatting::ParameterRows;
namespace row = splatting::neural_row;
namespace moment = neural_moment;

using Gradient = shared::SplatGradient<row::harmonics>;

/// Adds the derivative of NeuralStep::anisotropy by the logarithms of the semi-axes. With the
/// ratios r to the smallest one, which has r = 1 and moves all others, and their deviation D:
/// dD/dr_i = (r_i - mean) / (2 D).
HWY_INLINE void add_anisotropy(float weight, const Floats (&axes)[3], Floats* by_log) {
  const Floats smallest = hn::Min(axes[0], hn::Min(axes[1], axes[2]));
  const Floats by_smallest = hn::Div(constant(1.0f), smallest);
  Floats ratio[3], mean = hn::Zero(d), squares = hn::Zero(d);
  for (std::size_t k = 0; k < 3; ++k) {
    ratio[k] = hn::Mul(axes[k], by_smallest);
    mean = hn::MulAdd(ratio[k], constant(1.0f / 3), mean);
  }
  for (const Floats each : ratio) {
    const Floats from_mean = hn::Sub(each, mean);
    squares = hn::MulAdd(from_mean, from_mean, squares);
  }
  // Of a sphere, where D has no derivative, 0: ratios of floats differ by at least 1e-7.
  const Floats deviation = hn::Max(hn::Sqrt(hn::Mul(squares, constant(0.5f))), constant(1e-8f));
  const Floats factor = hn::Div(constant(0.5f * weight), deviation);
  Floats sum = hn::Zero(d);
  Floats by[3];
  for (std::size_t k = 0; k < 3; ++k) {
    by[k] = hn::Mul(factor, hn::Mul(hn::Sub(ratio[k], mean), ratio[k]));
    by[k] = hn::IfThenZeroElse(hn::Eq(axes[k], smallest), by[k]);
    sum = hn::Add(sum, by[k]);
  }
  Mask is_free = hn::Eq(smallest, smallest);  // the first of equally small ones moves the others
  for (std::size_t k = 0; k < 3; ++k) {
    const Mask moves = hn::And(is_free, hn::Eq(axes[k], smallest));
    is_free = hn::AndNot(moves, is_free);
    by_log[k] = hn::Add(by_log[k], hn::Sub(by[k], hn::IfThenElseZero(moves, sum)));
  }
}

/// Through splatting/neural/neural_kernels.cpp, in its unit of each splat. Names as in
/// neural_tile_kernels.hpp.
HWY_INLINE Gradient gradient_of(const BackwardInput<NeuralMoments>& input, const NeuralStep& step,
                                const NeuralParameters& parameters, std::size_t i) {
  Gradient gradient;
  const auto sums = shared::pair_sums(input.pairs, input.moments, i);
  const auto& m = sums.values;
  gradient.drawn = sums.drawn;
  gradient.evident = m[moment::evident];
  if (hn::AllFalse(d, sums.drawn)) return gradient;
  const ImageView& view = input.view;
  const ParameterRows& drawn = parameters.drawn;
  const auto load = [&](std::size_t r) { return hn::Load(d, drawn.row(r) + i); };
  const auto load_vector = [&](std::size_t r) {
    return Vector3{load(r), load(r + 1), load(r + 2)};
  };
  const auto set = [&](std::size_t r, const Vector3& value) {
    gradient.values[r] = value.x;
    gradient.values[r + 1] = value.y;
    gradient.values[r + 2] = value.z;
  };
  const Floats one = constant(1.0f);
  const Floats axes[3] = {load(row::semi_axes), load(row::semi_axes + 1), load(row::semi_axes + 2)};
  const Floats largest = hn::Max(axes[0], hn::Max(axes[1], axes[2]));
  const Floats by_unit = hn::Div(one, power_of_2_in(hn::Max(largest, constant(0x1p-126f))));
  const Floats by_largest = hn::Div(one, hn::Mul(largest, by_unit));

  // The network. A larger largest semi-axis divides the frequencies and the optical depth by its
  // factor: the latter like a factor of the amplitudes and of the offset.
  Floats by_largest_log = hn::Neg(hn::Mul(load(row::offset), m[moment::offset]));
  gradient.values[row::offset] = m[moment::offset];
  Vector3 by_center{hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  for (std::size_t k = 0; k < neurons; ++k) {
    const std::size_t at = moment::frequencies + k;
    const Vector3 frequency = load_vector(row::frequencies + 3 * k);
    const Vector3 by_frequency = product(
        transposed_product(view.view_from_layer, {m[at], m[at + neurons], m[at + 2 * neurons]}),
        by_largest);
    set(row::frequencies + 3 * k, by_frequency);
    const Floats by_phase = m[moment::phases + k], by_amplitude = m[moment::amplitudes + k];
    gradient.values[row::phases + k] = by_phase;
    gradient.values[row::amplitudes + k] = by_amplitude;
    by_largest_log = hn::Sub(by_largest_log, dot(frequency, by_frequency));
    by_largest_log = hn::NegMulAdd(load(row::amplitudes + k), by_amplitude, by_largest_log);
    by_center = difference(by_center, product(frequency, hn::Mul(by_phase, by_largest)));
  }

  // The ellipsoid: its semi-axes, ..
  Floats* by_axes = gradient.values + row::semi_axes;
  Mask is_free = hn::Eq(largest, largest);  // the first of equally large ones counts
  for (std::size_t k = 0; k < 3; ++k) {
    const Mask counts = hn::And(is_free, hn::Eq(axes[k], largest));
    is_free = hn::AndNot(counts, is_free);
    by_axes[k] = hn::Add(m[moment::shape + k], hn::IfThenElseZero(counts, by_largest_log));
  }
  if (step.anisotropy > 0) add_anisotropy(step.anisotropy, axes, by_axes);

  // .. its rotation: by small rotations about its own axes, then by the quaternion, which these
  // multiply from the right by (1, half of the angles).
  const auto turning = [&](std::size_t place, std::size_t j, std::size_t k) {
    const Floats ratio = hn::Div(axes[j], axes[k]), inverse = hn::Div(axes[k], axes[j]);
    return hn::Mul(m[moment::shape + place], hn::Sub(ratio, inverse));
  };
  const Vector3 turn{turning(3, 1, 2), turning(4, 2, 0), turning(5, 0, 1)};
  const Vector3 v = load_vector(row::rotation);
  const Floats w = load(row::rotation + 3);
  Floats squared = hn::Zero(d);
  for (std::size_t r = row::rotation; r < row::frequencies; ++r) {
    const Floats trained = hn::Load(d, parameters.trained(r) + i);
    squared = hn::MulAdd(trained, trained, squared);
  }
  const Floats factor = hn::Div(constant(2.0f), hn::Sqrt(squared));
  set(row::rotation, product(sum(product(turn, w), cross(v, turn)), factor));
  gradient.values[row::rotation + 3] = hn::Neg(hn::Mul(dot(v, turn), factor));

  // .. and its centre, also by the direction of the colour.
  const Rotation rotation = rotation_of(v.x, v.y, v.z, w);
  for (std::size_t k = 0; k < 3; ++k)
    by_center = sum(by_center, product(rotation.axes[k],
                                       hn::Div(m[moment::center + k], hn::Mul(axes[k], by_unit))));
  by_center = product(by_center, by_unit);
  const Vector3 offset = from_eye(view, load_vector(row::center));
  const Vector3 in_view = product(view.view_from_layer, by_center);
  const Floats depth = product(view.view_from_layer, offset).z;
  const Floats by_x = hn::Mul(in_view.x, hn::Mul(depth, constant(1 / view.fx)));
  const Floats by_y = hn::Mul(in_view.y, hn::Mul(depth, constant(1 / view.fy)));
  gradient.motion = hn::Sqrt(hn::MulAdd(by_x, by_x, hn::Mul(by_y, by_y)));
  gradient.color =
      shared::color_gradient_of(input.degree, drawn.row(row::harmonics), drawn.stride(), i, offset,
                                {m[moment::color], m[moment::color + 1], m[moment::color + 2]});
  set(row::center, sum(by_center, gradient.color.by_offset));
  return gradient;
}

struct NeuralLoops {
  using Moments = NeuralMoments;
  using Step = NeuralStep;
  using Parameters = NeuralParameters;
  static constexpr const auto& kinds = neural_parameter_kinds;
  static HWY_INLINE Gradient gradient_of(const BackwardInput<Moments>& input, const Step& step,
                                         const Parameters& parameters, std::size_t i) {
    return densities::gradient_of(input, step, parameters, i);
  }
  /// Limits the semi-axes, and computes the drawn values.
  static HWY_INLINE void activate(const Step& step, std::size_t i, Parameters& parameters) {
    shared::activate_lengths<row::semi_axes>(step.min_log_axis, step.max_log_axis, i, parameters);
    shared::activate_rotation<row::rotation>(i, parameters);
  }
};

const StepFunctions<NeuralMoments, NeuralStep, NeuralParameters>& neural_step_functions_on() {
  return shared::step_functions<NeuralLoops>;
}

}  // namespace densities
using densities::neural_step_functions_on;
}  // namespace tureen::trainer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tureen::trainer {

HWY_EXPORT(neural_step_functions_on);

const StepFunctions<NeuralMoments, NeuralStep, NeuralParameters>& neural_step_functions() {
  return HWY_DYNAMIC_DISPATCH(neural_step_functions_on)();
}

}  // namespace tureen::trainer
#endif
