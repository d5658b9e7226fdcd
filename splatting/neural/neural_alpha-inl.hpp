// The alpha of projected neural densities. Included once for each target of Highway.
//
// Points of a pixel's ray are depth * (x, y, 1): depth is the parameter, and the density's integral
// has the factor |(x, y, 1)|. With half of the chord's depth h, the middle m and the direction r, a
// neuron's integral over depth is 2 h sinc(w . r h) cos(w . m + b1). It divides by no small number
// (docs/numerics.md, N1).
//
// A small ellipsoid has chords in few pixels of a block: there, the lanes of a vector are the
// neurons, for one or two pixels at a time.
#if defined(TUREEN_NEURAL_ALPHA_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TUREEN_NEURAL_ALPHA_INL
#undef TUREEN_NEURAL_ALPHA_INL
#else
#define TUREEN_NEURAL_ALPHA_INL
#endif

#include <algorithm>
#include <bit>

#include "splatting/neural/neural_kernels.hpp"
#include "splatting/tiles/blending-inl.hpp"
#include "splatting/vector_math-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::splatting::HWY_NAMESPACE {

/// Lanes for the neurons of a pixel, pixels in a vector, and vectors for all neurons.
inline constexpr std::size_t neuron_lanes = std::min(lanes, neurons);
inline constexpr std::size_t pixels_together = lanes / neuron_lanes;
inline constexpr std::size_t neuron_parts = neurons / neuron_lanes;

/// The lanes of pixels whose neurons are computed together; equal if it is only one.
struct PixelPair {
  std::size_t first, second;
};

/// Calls act(pair) until the pixels of all bits were in one.
template <class Act>
HWY_INLINE void for_each_pair(unsigned pixels, const Act& act) {
  while (pixels != 0) {
    const int first = std::countr_zero(pixels);
    pixels &= pixels - 1;
    // Without a branch, which would be hard to predict.
    const unsigned rest = pixels_together == 2 && pixels != 0 ? pixels : 1u << first;
    const int second = std::countr_zero(rest);
    if constexpr (pixels_together == 2) pixels = rest & (rest - 1);
    act(PixelPair{std::size_t(first), std::size_t(second)});
  }
}

/// Values of neurons, for each pixel of a pair. `Tag`: FloatTag.
template <class Tag = FloatTag>
HWY_INLINE Floats of_neurons(const float* values, std::size_t part) {
#if HWY_TARGET != HWY_SCALAR
  if constexpr (const Tag tag; pixels_together == 2) {
    const auto all = hn::Load(hn::Half<Tag>(), values);
    return hn::Combine(tag, all, all);
  }
#endif
  return hn::Load(d, values + part * neuron_lanes);
}

/// The values of a pair of pixels, for each neuron.
HWY_INLINE Floats of_pixels(const float* values, PixelPair pair) {
  const Floats first = constant(values[pair.first]);
  if constexpr (pixels_together == 1) return first;
  return hn::IfThenElse(hn::FirstN(d, neuron_lanes), first, constant(values[pair.second]));
}

#if HWY_TARGET != HWY_SCALAR
/// Sets values[pixel] to the sum of the pixel's neurons, for a pair. `Tag`: FloatTag.
template <class Tag = FloatTag>
HWY_INLINE Floats with_sums(Floats values, PixelPair pair, Floats of_neurons) {
  Floats sums = hn::Add(of_neurons, hn::Shuffle2301(of_neurons));
  sums = hn::Add(sums, hn::Shuffle1032(sums));
  if constexpr (neuron_lanes == 8) sums = hn::Add(sums, hn::SwapAdjacentBlocks(sums));
  const Tag tag;
  const hn::RebindToSigned<FloatTag> di;
  const auto lane_is = [&](std::size_t lane) {
    return hn::RebindMask(d, hn::Eq(hn::Iota(di, 0), hn::Set(di, std::int32_t(lane))));
  };
  if constexpr (pixels_together == 2) {
    values = hn::IfThenElse(lane_is(pair.second), hn::ConcatUpperUpper(tag, sums, sums), values);
    sums = hn::ConcatLowerLower(tag, sums, sums);
  }
  return hn::IfThenElse(lane_is(pair.first), sums, values);
}
#endif

/// A network with its neurons in lanes.
struct NeuronVectors {
  Floats x[neuron_parts], y[neuron_parts], z[neuron_parts], phases[neuron_parts],
      amplitudes[neuron_parts];

  HWY_INLINE explicit NeuronVectors(const NeuralEntry& entry) {
    for (std::size_t part = 0; part < neuron_parts; ++part) {
      x[part] = of_neurons(entry.frequencies, part);
      y[part] = of_neurons(entry.frequencies + neurons, part);
      z[part] = of_neurons(entry.frequencies + 2 * neurons, part);
      phases[part] = of_neurons(entry.phases, part);
      amplitudes[part] = of_neurons(entry.amplitudes, part);
    }
  }
};

/// What the neurons need of a pixel's chord.
struct NeuronChord {
  Floats x, y;  // of the ray at depth 1
  Vector3 middle;
  Floats half;

  /// Of the ray's point at depth 1, and the neuron's phase in the middle.
  HWY_INLINE Floats frequency(const Vector3& w) const {
    return hn::MulAdd(w.x, x, hn::MulAdd(w.y, y, w.z));
  }
  HWY_INLINE Floats phase(const Vector3& w, Floats constant) const {
    return hn::Add(dot(w, middle), constant);
  }
};

/// The chords of a vector of pixels, in memory.
struct alignas(64) NeuronChords {
  float x[lanes], y[lanes], middle[3][lanes], half[lanes];

  HWY_INLINE void set(const NeuronChord& chord) {
    hn::Store(chord.x, d, x);
    hn::Store(chord.y, d, y);
    hn::Store(chord.middle.x, d, middle[0]);
    hn::Store(chord.middle.y, d, middle[1]);
    hn::Store(chord.middle.z, d, middle[2]);
    hn::Store(chord.half, d, half);
  }
  HWY_INLINE NeuronChord all() const {
    const auto load = [](const float* values) { return hn::Load(d, values); };
    return {load(x), load(y), {load(middle[0]), load(middle[1]), load(middle[2])}, load(half)};
  }
  HWY_INLINE NeuronChord of(PixelPair pair) const {
    const auto pick = [&](const float* values) { return of_pixels(values, pair); };
    return {pick(x), pick(y), {pick(middle[0]), pick(middle[1]), pick(middle[2])}, pick(half)};
  }
};

/// A ray's part in an ellipsoid, between the near plane and the opaque surface.
struct DensityChord : NeuronChord {
  // The middle is from the centre, and `half` half of the depth between begin and end.
  Mask exists;
  // Of the whole chord, in the unit sphere's space; for derivatives.
  Vector3 in_sphere, direction;  // its middle, and the ray's change with the depth
  Floats by_speed;               // 1 / direction . direction
  Floats half_chord;             // of its depth
  Mask begins_near;              // the near plane cuts it

  DensityChord() = default;
  /// `behind`: the depth of the opaque surface, in the entry's unit.
  HWY_INLINE DensityChord(const NeuralEntry& entry, Floats ray_x, Floats ray_y, Floats behind) {
    x = ray_x, y = ray_y;
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

    // Depths from the middle of the chord: only the parts that are cut depend on the distance.
    half_chord = hn::Sqrt(hn::Mul(hn::ZeroIfNegative(discriminant), by_speed));
    const Floats to_middle = hn::Add(first, second), depth = hn::Add(center_z, to_middle);
    const Floats near = hn::Sub(constant(entry.near), depth);
    begins_near = hn::Gt(near, hn::Neg(half_chord));
    const Floats begin = hn::Max(hn::Neg(half_chord), near);
    const Floats end = hn::Min(half_chord, hn::Sub(behind, depth));
    exists = hn::And(exists, hn::Gt(end, begin));
    half = hn::Mul(constant(0.5f), hn::Sub(end, begin));
    const Floats at = hn::MulAdd(constant(0.5f), hn::Add(begin, end), to_middle);
    middle = {hn::MulAdd(at, x, start_x), hn::MulAdd(at, y, start_y), at};
  }
};

/// Whether the image of an entry may cover pixels: a few operations, before those of the chord.
HWY_INLINE Mask in_outline(const NeuralEntry& entry, Floats x, Floats y) {
  const auto& [center_x, center_y, p, q, r] = entry.outline;
  const Floats from_x = hn::Sub(x, constant(center_x)), from_y = hn::Sub(y, constant(center_y));
  const Floats u = hn::MulAdd(constant(p), from_x, hn::Mul(constant(q), from_y));
  const Floats v = hn::Mul(constant(r), from_y);
  // True for NaN: may cover any pixel.
  return hn::Not(hn::Gt(hn::MulAdd(u, u, hn::Mul(v, v)), constant(1.0f)));
}

/// Of rays through these points at depth 1.
HWY_INLINE Floats ray_length(Floats x, Floats y) {
  return hn::Sqrt(hn::MulAdd(x, x, hn::MulAdd(y, y, constant(1.0f))));
}

/// The mean of the density over the chords of these pixels; elsewhere 0 or any finite value.
HWY_INLINE Floats mean_density(const NeuralEntry& entry, const NeuronChords& chords,
                               [[maybe_unused]] unsigned pixels) {
#if HWY_TARGET != HWY_SCALAR
  // For more pixels, vectors of pixels are faster: they need no sums over lanes.
  if (4 * std::size_t(std::popcount(pixels)) <= 3 * lanes) {
    const NeuronVectors network(entry);
    Floats density = hn::Zero(d);
    for_each_pair(pixels, [&](PixelPair pair) {
      const NeuronChord chord = chords.of(pair);
      Floats sum = hn::Zero(d);
      for (std::size_t k = 0; k < neuron_parts; ++k) {
        const Vector3 w{network.x[k], network.y[k], network.z[k]};
        const Floats in_middle = cos_of(chord.phase(w, network.phases[k]));
        sum = hn::MulAdd(hn::Mul(network.amplitudes[k], in_middle),
                         sinc_of(hn::Mul(chord.frequency(w), chord.half)), sum);
      }
      density = with_sums(density, pair, sum);
    });
    return hn::Add(density, constant(entry.offset));
  }
#endif
  const NeuronChord chord = chords.all();
  Floats density = constant(entry.offset);
  for (std::size_t k = 0; k < neurons; ++k) {
    const float* at = entry.frequencies + k;
    const Vector3 w{constant(at[0]), constant(at[neurons]), constant(at[2 * neurons])};
    const Floats in_middle = cos_of(chord.phase(w, constant(entry.phases[k])));
    density = hn::MulAdd(hn::Mul(constant(entry.amplitudes[k]), in_middle),
                         sinc_of(hn::Mul(chord.frequency(w), chord.half)), density);
  }
  return density;
}

/// The integral of the density along the ray, in units of the largest semi-axis, from its mean.
HWY_INLINE Floats optical_depth(const NeuralEntry& entry, Floats half, Floats length,
                                Floats density) {
  return hn::Mul(hn::Mul(hn::Mul(constant(entry.twice_by_largest), half), length), density);
}

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

  /// The point of the pixel's ray at depth 1.
  HWY_INLINE Floats ray_x(Floats x) const {
    return hn::Mul(hn::Sub(x, constant(cx)), constant(by_fx));
  }
  HWY_INLINE Floats ray_y(Floats y) const {
    return hn::Mul(hn::Sub(y, constant(cy)), constant(by_fy));
  }
  HWY_INLINE DensityChord chord(const NeuralEntry& entry, Floats x, Floats y,
                                Floats inverse_behind) const {
    return {entry, ray_x(x), ray_y(y),
            hn::Div(constant(entry.by_unit), inverse_behind)};  // perhaps infinity
  }

  HWY_INLINE Mask operator()(const NeuralEntry& entry, Floats x, Floats y, Floats inverse_behind,
                             Floats& alpha) const {
    const Mask covered = in_outline(entry, x, y);
    if (none(covered)) return covered;
    const DensityChord chord = this->chord(entry, x, y, inverse_behind);
    if (none(chord.exists)) return chord.exists;
    NeuronChords chords;
    chords.set(chord);
    const Floats density = mean_density(entry, chords, bits_of(d, chord.exists));
    const Floats depth = optical_depth(entry, chord.half, ray_length(chord.x, chord.y), density);
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
    const DensityChord chord = camera.chord(entry, x, y, inverse_behind);
    return hn::Mul(hn::Add(chord.middle.z, constant(entry.center[2])), constant(1 / entry.by_unit));
  }
};

}  // namespace tureen::splatting::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
