#include "trainer/splats/neural/neural_tile_kernels.hpp"

#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trainer/splats/neural/neural_tile_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "splatting/neural/neural_alpha-inl.hpp"
#include "trainer/splats/tile_loops-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::trainer::HWY_NAMESPACE {
namespace neural_tiles {

using namespace tiles;
using splatting::NeuralEntry;
using splatting::neurons;
namespace moment = neural_moment;

/// sin(x) / x and its derivative, with one division.
struct Sinc {
  Floats value, slope;

  HWY_INLINE Sinc(Floats x, Floats cosine) {
    const Floats one = constant(1.0f), size = hn::Abs(x);
    // Up to 2^-12, 1 is exact to 1e-8.
    const Mask large = hn::Gt(size, constant(0x1p-12f));
    const Floats inverse = hn::Div(one, hn::IfThenElse(large, x, one));
    value = hn::IfThenElse(large, hn::Mul(sin_of(x), inverse), one);
    // Below 1/2 by the series, exact to 3e-9 of the value there: the difference would cancel.
    const Floats xx = hn::Mul(x, x);
    Floats series = hn::NegMulAdd(xx, constant(1.0f / 54), one);
    series = hn::NegMulAdd(hn::Mul(xx, constant(1.0f / 28)), series, one);
    series = hn::NegMulAdd(hn::Mul(xx, constant(0.1f)), series, one);
    slope = hn::IfThenElse(hn::Lt(size, constant(0.5f)),
                           hn::Mul(hn::Mul(x, constant(-1.0f / 3)), series),
                           hn::Mul(hn::Sub(cosine, value), inverse));
  }
};

#if HWY_TARGET != HWY_SCALAR
/// The sum of a vector's groups of four lanes.
template <class V>
HWY_INLINE hn::Vec<hn::CappedTag<float, 4>> sum_of_groups(V values) {
  const hn::DFromV<V> dv;
  if constexpr (hn::MaxLanes(dv) > 4) {
    const hn::Half<decltype(dv)> dh;
    return sum_of_groups(hn::Add(hn::LowerHalf(dh, values), hn::UpperHalf(dh, values)));
  } else {
    return values;
  }
}
#endif

/// Adds the sums over lanes of 4 vectors to 4 numbers.
HWY_INLINE void add_lanes(const Floats* sums, float* line) {
#if HWY_TARGET != HWY_SCALAR
  const auto halved = [](Floats a, Floats b) {
    return hn::Add(hn::InterleaveLower(d, a, b), hn::InterleaveUpper(d, a, b));
  };
  const hn::Repartition<double, FloatTag> dd;
  const auto ab = hn::BitCast(dd, halved(sums[0], sums[1]));
  const auto cd = hn::BitCast(dd, halved(sums[2], sums[3]));
  const Floats groups = hn::Add(hn::BitCast(d, hn::InterleaveLower(dd, ab, cd)),
                                hn::BitCast(d, hn::InterleaveUpper(dd, ab, cd)));
  const hn::CappedTag<float, 4> d4;
  hn::Store(hn::Add(hn::Load(d4, line), sum_of_groups(groups)), d4, line);
#else
  for (std::size_t k = 0; k < 4; ++k) line[k] += hn::GetLane(sums[k]);
#endif
}

/// The kernel of the loops. A value is alpha before it is limited to the largest, or below 0.
struct Densities {
  using Entry = NeuralEntry;
  static constexpr bool sums_squares = false;
  const ImageView& view;
  const NeuralAlpha camera;

  Densities(const ImageView& image, float) : view(image), camera(image) {}

  HWY_INLINE DensityChord chord_of(const Entry& entry, Floats x, Floats y) const {
    return {entry, hn::Mul(hn::Sub(x, constant(camera.cx)), constant(camera.by_fx)),
            hn::Mul(hn::Sub(y, constant(camera.cy)), constant(camera.by_fy)), hn::Zero(d)};
  }
  HWY_INLINE Floats value_of(const Entry& entry, Floats x, Floats y) const {
    const DensityChord chord = chord_of(entry, x, y);
    if (none(chord.exists)) return constant(-1.0f);
    const Floats alpha = one_minus_exp_of(chord.optical_depth(entry));
    return hn::IfThenElse(chord.exists, alpha, constant(-1.0f));
  }
  HWY_INLINE Floats threshold_of(const Entry&) const { return constant(view.min_alpha); }
  HWY_INLINE Floats alpha_of(const Entry&, Floats value) const { return value; }
};

/// Sums over the pixels of a block, lane by lane. Where a vector has all of them, they are its
/// values.
struct BlockSums {
  Floats values[moment::count];

  HWY_INLINE BlockSums() {
    for (std::size_t k = parts > 1 ? 0 : std::size_t(moment::evident); k < moment::count; ++k)
      values[k] = hn::Zero(d);
  }
  HWY_INLINE void add(std::size_t place, Floats value) {
    values[place] = parts > 1 ? hn::Add(values[place], value) : value;
  }
  HWY_INLINE void add_to(NeuralMoments& moments) const {
    for (std::size_t k = 0; k < moment::count; k += 4) add_lanes(values + k, moments.values + k);
  }
};

/// Blends an entry again, and adds its derivatives at a vector of a block's pixels. Returns whether
/// the entry has any there; if not, no sum is set.
HWY_INLINE bool replay(const Densities& kernel, const NeuralEntry& entry, BlockGradient& block,
                       std::size_t part, BlockSums& sums) {
  const DensityChord chord = kernel.chord_of(entry, block.x[part], block.y[part]);
  if (none(chord.exists)) return false;
  const Floats zero = hn::Zero(d), one = constant(1.0f);
  // Of each neuron, the derivatives of the density's mean over the chord: by its amplitude, its
  // phase, and through the frequency along the ray.
  Floats by_amplitude[neurons], by_phase[neurons], by_along[neurons];
  Floats density = constant(entry.offset), ends = density, by_middle = zero;
  for (std::size_t k = 0; k < neurons; ++k) {
    const float* w = entry.frequencies + 3 * k;
    const Floats w_x = constant(w[0]), w_y = constant(w[1]), w_z = constant(w[2]);
    const Floats frequency = hn::MulAdd(w_x, chord.x, hn::MulAdd(w_y, chord.y, w_z));
    const Floats phase = hn::Add(dot({w_x, w_y, w_z}, chord.middle), constant(entry.phases[k]));
    const Floats x = hn::Mul(frequency, chord.half);
    const Floats cosine = cos_of(x);
    const Sinc sinc(x, cosine);
    const Floats amplitude = constant(entry.amplitudes[k]);
    const Floats cos_phase = cos_of(phase), in_phase = hn::Mul(amplitude, cos_phase);
    const Floats across = hn::Neg(hn::Mul(amplitude, sin_of(phase)));
    by_amplitude[k] = hn::Mul(cos_phase, sinc.value);
    by_phase[k] = hn::Mul(across, sinc.value);
    by_along[k] = hn::Mul(in_phase, hn::Mul(sinc.slope, chord.half));
    density = hn::MulAdd(in_phase, sinc.value, density);
    ends = hn::MulAdd(in_phase, cosine, ends);
    by_middle = hn::MulAdd(by_phase[k], frequency, by_middle);
  }
  const Floats length = hn::Sqrt(hn::MulAdd(chord.x, chord.x, hn::MulAdd(chord.y, chord.y, one)));
  const Floats scale = hn::Mul(constant(entry.twice_by_largest), length);
  const Floats by_density = hn::Mul(scale, chord.half);
  const Floats unlimited = one_minus_exp_of(hn::Mul(by_density, density));
  const Mask covered = hn::And(chord.exists, hn::Ge(unlimited, constant(kernel.view.min_alpha)));
  const Floats alpha = hn::Min(unlimited, constant(kernel.view.max_alpha));
  const Floats ratio = hn::Div(alpha, hn::Sub(one, alpha));
  const auto [weight, h] = blend_again(kernel.view, entry, covered, unlimited, ratio, block, part);
  // dL/dtau = dL/d ln(alpha) (1 - alpha) / alpha, since 1 - alpha = exp(-tau).
  const Floats by_depth =
      hn::IfThenElseZero(hn::And(covered, hn::Gt(hn::Abs(h), zero)), hn::Div(h, ratio));

  const Floats g = hn::Mul(by_depth, by_density);
  for (std::size_t k = 0; k < neurons; ++k) {
    const Floats phase = hn::Mul(g, by_phase[k]), along = hn::Mul(g, by_along[k]);
    const std::size_t at = moment::frequencies + 3 * k;
    sums.add(at, hn::MulAdd(along, chord.x, hn::Mul(phase, chord.middle.x)));
    sums.add(at + 1, hn::MulAdd(along, chord.y, hn::Mul(phase, chord.middle.y)));
    sums.add(at + 2, hn::MulAdd(phase, chord.middle.z, along));
    sums.add(moment::phases + k, phase);
    sums.add(moment::amplitudes + k, hn::Mul(g, by_amplitude[k]));
  }
  sums.add(moment::offset, g);

  // By half of the chord's length and by its middle. Where the near plane is its beginning, only
  // its end moves: by the sum of both, half each.
  Floats by_half = hn::Mul(by_depth, hn::Mul(scale, ends));
  Floats by_position = hn::Mul(g, by_middle);
  const Floats by_end = hn::Mul(constant(0.5f), hn::Add(by_half, by_position));
  by_half = hn::IfThenElse(chord.begins_near, by_end, by_half);
  by_position = hn::IfThenElse(chord.begins_near, by_end, by_position);
  // A millionth of the unit: a shorter chord only has alpha for a density beyond 1,000, and its
  // derivative would outweigh all others.
  const Floats half_chord = hn::Max(chord.half_chord, constant(1e-6f));
  const Floats through_half = hn::Mul(by_half, chord.by_speed);
  const Floats through_position = hn::Mul(by_position, chord.by_speed);
  const Vector3 &middle = chord.in_sphere, &direction = chord.direction;
  const Vector3 p =
      sum(product(middle, hn::Div(through_half, half_chord)), product(direction, through_position));
  const Vector3 q =
      sum(product(direction, hn::Mul(through_half, half_chord)), product(middle, through_position));
  const auto both = [](Floats m, Floats p_k, Floats r, Floats q_k) {
    return hn::MulAdd(m, p_k, hn::Mul(r, q_k));
  };
  sums.add(moment::shape, both(middle.x, p.x, direction.x, q.x));
  sums.add(moment::shape + 1, both(middle.y, p.y, direction.y, q.y));
  sums.add(moment::shape + 2, both(middle.z, p.z, direction.z, q.z));
  sums.add(moment::shape + 3, both(middle.y, p.z, direction.y, q.z));
  sums.add(moment::shape + 4, both(middle.x, p.z, direction.x, q.z));
  sums.add(moment::shape + 5, both(middle.x, p.y, direction.x, q.y));
  sums.add(moment::center, p.x);
  sums.add(moment::center + 1, p.y);
  sums.add(moment::center + 2, p.z);
  sums.add(moment::color, hn::Mul(weight, block.red[part]));
  sums.add(moment::color + 1, hn::Mul(weight, block.green[part]));
  sums.add(moment::color + 2, hn::Mul(weight, block.blue[part]));
  return true;
}

/// TileFunctions::blend_backward. A pair has so many sums that each block adds its own to memory.
void blend_densities_backward(const ImageView& view, std::span<const NeuralEntry> entries,
                              std::span<const std::uint32_t> tile,
                              std::span<const std::uint32_t> numbers, const TileRecord& record,
                              const TileGradient& gradient, TileScratch&,
                              std::span<NeuralMoments> moments) {
  const Densities kernel(view, 0);
  for (const std::uint32_t number : numbers) moments[number] = {};
  for (int i = 0; i < blocks_a_tile; ++i) {
    const std::uint32_t begin = i == 0 ? 0 : record.ends[i - 1], end = record.ends[i];
    if (begin == end) continue;
    BlockGradient block(gradient, i);
    for (std::uint32_t at = begin; at < end; ++at) {
      const std::uint32_t place = record.blended[at] & ~TileRecord::evident_bit;
      NeuralMoments& out = moments[numbers[place]];
      BlockSums sums;
      bool has_sums = false;
      for (std::size_t part = 0; part < parts; ++part)
        has_sums |= replay(kernel, entries[tile[place] & place_mask], block, part, sums);
      if (has_sums) sums.add_to(out);
      if (record.blended[at] & TileRecord::evident_bit) out.values[moment::evident] += 1;
    }
  }
}

const TileFunctions<NeuralEntry, NeuralMoments>& neural_tile_functions_on() {
  static constexpr TileFunctions<NeuralEntry, NeuralMoments> functions{
      &blend_tile_recorded<Densities>, &blend_densities_backward};
  return functions;
}

}  // namespace neural_tiles
using neural_tiles::neural_tile_functions_on;
}  // namespace tureen::trainer::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tureen::trainer {

HWY_EXPORT(neural_tile_functions_on);

const TileFunctions<splatting::NeuralEntry, NeuralMoments>& neural_tile_functions() {
  return HWY_DYNAMIC_DISPATCH(neural_tile_functions_on)();
}

}  // namespace tureen::trainer
#endif
