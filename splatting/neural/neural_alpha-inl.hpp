// The alpha of projected neural densities. Included once for each target of Highway.
//
// Points of a pixel's ray are depth * (x, y, 1): depth is the parameter, and the density's integral
// has the factor |(x, y, 1)|. With half of the chord's depth h, the middle m and the direction r, a
// neuron's integral over depth is 2 h sinc(w . r h) cos(w . m + b1). It divides by no small number
// (docs/numerics.md, N1).
#if defined(TUREEN_NEURAL_ALPHA_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TUREEN_NEURAL_ALPHA_INL
#undef TUREEN_NEURAL_ALPHA_INL
#else
#define TUREEN_NEURAL_ALPHA_INL
#endif

#include "splatting/neural/neural_kernels.hpp"
#include "splatting/tiles/blending-inl.hpp"
#include "splatting/vector_math-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::splatting::HWY_NAMESPACE {

/// A ray's part in an ellipsoid, between the near plane and the opaque surface.
struct DensityChord {
  Floats x, y;     // of the ray at depth 1
  Vector3 middle;  // from the centre
  Floats half;     // of the depth between begin and end
  Mask exists;
  // Of the whole chord, in the unit sphere's space; for derivatives.
  Vector3 in_sphere, direction;  // its middle, and the ray's change with the depth
  Floats by_speed;               // 1 / direction . direction
  Floats half_chord;             // of its depth
  Mask begins_near;              // the near plane cuts it

  HWY_INLINE DensityChord(const NeuralEntry& entry, Floats ray_x, Floats ray_y,
                          Floats inverse_behind)
      : x(ray_x), y(ray_y) {
    const float* m = entry.sphere_from_view;
    const Floats center_x = constant(entry.center[0]), center_y = constant(entry.center[1]),
                 center_z = constant(entry.center[2]);
    // The point of the ray at the depth of the centre, relative to it. Then, in the unit sphere's
    // space, the middle of the chord, corrected once: the distance of the eye does not enter its
    // rounding (docs/numerics.md, N2).
    const Floats start_x = hn::MulSub(x, center_z, center_x);
    const Floats start_y = hn::MulSub(y, center_z, center_y);
    const auto start = [&](const float* row) {
      return hn::MulAdd(constant(row[0]), start_x, hn::Mul(constant(row[1]), start_y));
    };
    const auto along = [&](const float* row) {
      return hn::MulAdd(constant(row[0]), x, hn::MulAdd(constant(row[1]), y, constant(row[2])));
    };
    direction = {along(m), along(m + 3), along(m + 6)};
    const Vector3 from{start(m), start(m + 3), start(m + 6)};
    by_speed = hn::Div(constant(1.0f), dot(direction, direction));
    const auto step_to_middle = [&](const Vector3& point) {
      return hn::Neg(hn::Mul(dot(point, direction), by_speed));
    };
    const Floats first = step_to_middle(from);
    const Vector3 near_middle = sum(from, product(direction, first));
    const Floats second = step_to_middle(near_middle);
    in_sphere = sum(near_middle, product(direction, second));
    // False for NaN.
    const Floats discriminant = hn::Sub(constant(1.0f), dot(in_sphere, in_sphere));
    exists = hn::Gt(discriminant, hn::Zero(d));
    if (none(exists)) return;

    // Depths from the middle of the chord: only the parts that are cut depend on the distance.
    half_chord = hn::Sqrt(hn::Mul(hn::ZeroIfNegative(discriminant), by_speed));
    const Floats to_middle = hn::Add(first, second), depth = hn::Add(center_z, to_middle);
    const Floats behind = hn::Div(constant(entry.by_unit), inverse_behind);  // perhaps infinity
    const Floats near = hn::Sub(constant(entry.near), depth);
    begins_near = hn::Gt(near, hn::Neg(half_chord));
    const Floats begin = hn::Max(hn::Neg(half_chord), near);
    const Floats end = hn::Min(half_chord, hn::Sub(behind, depth));
    exists = hn::And(exists, hn::Gt(end, begin));
    half = hn::Mul(constant(0.5f), hn::Sub(end, begin));
    const Floats at = hn::MulAdd(constant(0.5f), hn::Add(begin, end), to_middle);
    middle = {hn::MulAdd(at, x, start_x), hn::MulAdd(at, y, start_y), at};
  }

  /// The integral of the density along it, in units of the largest semi-axis.
  HWY_INLINE Floats optical_depth(const NeuralEntry& entry) const {
    Floats density = constant(entry.offset);
    for (std::size_t k = 0; k < neurons; ++k) {
      const float* w = entry.frequencies + 3 * k;
      const Floats w_x = constant(w[0]), w_y = constant(w[1]), w_z = constant(w[2]);
      const Floats frequency = hn::MulAdd(w_x, x, hn::MulAdd(w_y, y, w_z));
      const Floats phase = hn::Add(dot({w_x, w_y, w_z}, middle), constant(entry.phases[k]));
      density = hn::MulAdd(hn::Mul(constant(entry.amplitudes[k]), cos_of(phase)),
                           sinc_of(hn::Mul(frequency, half)), density);
    }
    const Floats length = hn::Sqrt(hn::MulAdd(x, x, hn::MulAdd(y, y, constant(1.0f))));
    return hn::Mul(hn::Mul(hn::Mul(constant(entry.twice_by_largest), half), length), density);
  }
};

/// `alpha_of` of blend_entries().
struct NeuralAlpha {
  float cx, cy, by_fx, by_fy, min_alpha;

  explicit NeuralAlpha(const ImageView& view)
      : cx(view.cx),
        cy(view.cy),
        by_fx(1 / view.fx),
        by_fy(1 / view.fy),
        min_alpha(view.min_alpha) {}

  HWY_INLINE unsigned blocks(const NeuralEntry&, const BlockCorners&) const { return all_blocks; }

  HWY_INLINE Mask operator()(const NeuralEntry& entry, Floats x, Floats y, Floats inverse_behind,
                             Floats& alpha) const {
    const DensityChord chord(entry, hn::Mul(hn::Sub(x, constant(cx)), constant(by_fx)),
                             hn::Mul(hn::Sub(y, constant(cy)), constant(by_fy)), inverse_behind);
    if (none(chord.exists)) return chord.exists;
    const Floats depth = chord.optical_depth(entry);
    alpha = one_minus_exp_of(depth);
    // min_alpha does not reject a NaN, which limits of vectors may hide (docs/numerics.md, B3).
    const Mask visible = hn::And(hn::Gt(depth, hn::Zero(d)), hn::Ge(alpha, constant(min_alpha)));
    return hn::And(chord.exists, visible);
  }
};

/// The depth of the middle of a chord, in layer units.
struct NeuralDepth {
  NeuralAlpha camera;

  HWY_INLINE Floats operator()(const NeuralEntry& entry, Floats x, Floats y,
                               Floats inverse_behind) const {
    const DensityChord chord(
        entry, hn::Mul(hn::Sub(x, constant(camera.cx)), constant(camera.by_fx)),
        hn::Mul(hn::Sub(y, constant(camera.cy)), constant(camera.by_fy)), inverse_behind);
    return hn::Mul(hn::Add(chord.middle.z, constant(entry.center[2])), constant(1 / entry.by_unit));
  }
};

}  // namespace tureen::splatting::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
