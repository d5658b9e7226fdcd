#include "trainer/splats/neural/neural_tile_kernels.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

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

  HWY_INLINE Sinc(Floats x, Floats sine, Floats cosine) {
    const Floats one = constant(1.0f), size = hn::Abs(x);
    // Up to 2^-12, 1 is exact to 1e-8.
    const Mask large = hn::Gt(size, constant(0x1p-12f));
    const Floats inverse = hn::Div(one, hn::IfThenElse(large, x, one));
    value = hn::IfThenElse(large, hn::Mul(sine, inverse), one);
    // Below 1/4 by the series, exact to 2e-8 of the value there: the difference would cancel, and
    // is exact to 1e-5 of the value beyond.
    const Floats xx = hn::Mul(x, x);
    Floats series = hn::NegMulAdd(xx, constant(1.0f / 28), one);
    series = hn::NegMulAdd(hn::Mul(xx, constant(0.1f)), series, one);
    slope = hn::IfThenElse(hn::Lt(size, constant(0.25f)),
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

#if HWY_TARGET != HWY_SCALAR
/// Four vectors' sums over every fourth lane, from that of the first vector on.
HWY_INLINE Floats sums_in_groups(Floats v0, Floats v1, Floats v2, Floats v3) {
  const auto halved = [](Floats a, Floats b) {
    return hn::Add(hn::InterleaveLower(d, a, b), hn::InterleaveUpper(d, a, b));
  };
  const hn::Repartition<double, FloatTag> dd;
  const auto ab = hn::BitCast(dd, halved(v0, v1)), cd = hn::BitCast(dd, halved(v2, v3));
  return hn::Add(hn::BitCast(d, hn::InterleaveLower(dd, ab, cd)),
                 hn::BitCast(d, hn::InterleaveUpper(dd, ab, cd)));
}
#endif

/// Adds the sums over lanes of 4 vectors to 4 numbers.
HWY_INLINE void add_lanes(const Floats* sums, float* line) {
#if HWY_TARGET != HWY_SCALAR
  const hn::CappedTag<float, 4> d4;
  const auto total = sum_of_groups(sums_in_groups(sums[0], sums[1], sums[2], sums[3]));
  hn::Store(hn::Add(hn::Load(d4, line), total), d4, line);
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

  /// The chord where nothing opaque is.
  HWY_INLINE DensityChord chord_of(const Entry& entry, Floats x, Floats y) const {
    return {entry, camera.ray_x(x), camera.ray_y(y),
            constant(std::numeric_limits<float>::infinity())};
  }

  /// First the outlines of all entries, then the chords, then the networks: whether a pixel has a
  /// chord is hard to predict, and takes long to compute.
  HWY_INLINE void find_covering(std::span<const Entry> entries, std::span<const std::uint32_t> tile,
                                std::size_t begin, std::size_t end, const Block& block,
                                const Mask (&open)[parts], Covering& covering) const {
    const auto entry_at = [&](std::size_t place) -> const Entry& {
      return entries[tile[place] & place_mask];
    };
    std::uint32_t places[tested_batch];
    std::size_t count = 0;
    for (std::size_t k = begin; k < end; ++k) {
      bool covers = false;
      for (std::size_t part = 0; part < parts; ++part)
        covers |= !none(hn::And(open[part], in_outline(entry_at(k), block.x[part], block.y[part])));
      places[count] = std::uint32_t(k);
      count += covers;
    }
    NeuronChords chords[tested_batch][parts];
    unsigned pixels[tested_batch];
    const std::size_t tested = std::exchange(count, 0);
    for (std::size_t i = 0; i < tested; ++i) {
      pixels[count] = 0;
      for (std::size_t part = 0; part < parts; ++part) {
        const DensityChord chord = chord_of(entry_at(places[i]), block.x[part], block.y[part]);
        chords[count][part].set(chord);
        pixels[count] |= bits_of(d, hn::And(open[part], chord.exists)) << part * lanes;
      }
      places[count] = places[i];
      count += pixels[count] != 0;
    }
    Floats length[parts];
    for (std::size_t part = 0; part < parts; ++part)
      length[part] = ray_length(camera.ray_x(block.x[part]), camera.ray_y(block.y[part]));
    for (std::size_t i = 0; i < count; ++i) {
      const Entry& entry = entry_at(places[i]);
      bool covers = false;
      for (std::size_t part = 0; part < parts; ++part) {
        const unsigned here = pixels[i] >> part * lanes & ((1u << lanes) - 1);
        const NeuronChords& at = chords[i][part];
        const Floats density = mean_density(entry, at, here);
        const Floats alpha =
            one_minus_exp_of(optical_depth(entry, hn::Load(d, at.half), length[part], density));
        const std::uint8_t bytes[8] = {std::uint8_t(here), std::uint8_t(here >> 8)};
        const Floats value = hn::IfThenElse(hn::LoadMaskBits(d, bytes), alpha, constant(-1.0f));
        hn::Store(value, d, covering.values[covering.count] + part * lanes);
        covers |= !none(hn::Ge(value, threshold_of(entry)));
      }
      covering.place[covering.count] = places[i];
      covering.count += covers;
    }
  }
  HWY_INLINE Floats threshold_of(const Entry&) const { return constant(view.min_alpha); }
  HWY_INLINE Floats alpha_of(const Entry&, Floats value) const { return value; }
};

/// The neurons of an entry at the pixels of a vector that have chords.
class NeuronsAgain {
 public:
  HWY_INLINE void compute(const NeuralEntry& entry, const NeuronChord& chord, unsigned pixels) {
    chords_.set(chord);
    pixels_ = pixels;
    const NeuronVectors network(entry);
    const Floats zero = hn::Zero(d);
    for (std::size_t k = 0; k < 4; ++k) hn::Store(zero, d, sums_ + k * lanes);
    Neuron* out = neurons_;
    for_each_pair(pixels, [&](PixelPair pair) {
      const NeuronChord at = chords_.of(pair);
      Floats density = zero, ends = zero, by_middle = zero;
      for (std::size_t k = 0; k < neuron_parts; ++k, ++out) {
        const Vector3 w{network.x[k], network.y[k], network.z[k]};
        const Floats frequency = at.frequency(w), x = hn::Mul(frequency, at.half);
        const Angle along(x), middle(at.phase(w, network.phases[k]));
        const Floats cosine = along.cosine();
        const Sinc sinc(x, along.sine(), cosine);
        const Floats cos_phase = middle.cosine(), amplitude = network.amplitudes[k];
        const Floats in_phase = hn::Mul(amplitude, cos_phase);
        const Floats across = hn::Neg(hn::Mul(amplitude, middle.sine()));
        out->by_amplitude = hn::Mul(cos_phase, sinc.value);
        out->by_phase = hn::Mul(across, sinc.value);
        out->by_along = hn::Mul(in_phase, hn::Mul(sinc.slope, at.half));
        density = hn::MulAdd(in_phase, sinc.value, density);
        ends = hn::MulAdd(in_phase, cosine, ends);
        by_middle = hn::MulAdd(out->by_phase, frequency, by_middle);
      }
      store_sums(pair, density, ends, by_middle);
    });
  }

  /// Sums over the neurons, at the pixels; elsewhere 0.
  HWY_INLINE void read(Floats& density, Floats& ends, Floats& by_middle) const {
#if HWY_TARGET != HWY_SCALAR
    Floats none;
    hn::LoadInterleaved4(d, sums_, density, ends, by_middle, none);
#else
    density = hn::Load(d, sums_), ends = hn::Load(d, sums_ + 1), by_middle = hn::Load(d, sums_ + 2);
#endif
  }

  /// The factor of the derivatives of the density's mean over the chord, at the pixels.
  HWY_INLINE void set_factor(Floats factor) {
    hn::Store(factor, d, factors_);
    hn::Store(hn::Zero(d), d, factors_ + lanes);
  }
  /// Adds the derivatives by the network.
  HWY_INLINE void add_to(float* moments) const {
    Floats by_x[neuron_parts], by_y[neuron_parts], by_z[neuron_parts], by_phase[neuron_parts],
        by_amplitude[neuron_parts];
    for (std::size_t k = 0; k < neuron_parts; ++k)
      by_x[k] = by_y[k] = by_z[k] = by_phase[k] = by_amplitude[k] = hn::Zero(d);
    const Neuron* neuron = neurons_;
    for_each_pair(pixels_, [&](PixelPair pair) {
      const NeuronChord at = chords_.of(pair);
      // A pixel without a partner counts once.
      const std::size_t second = pair.second != pair.first ? pair.second : lanes;
      const Floats g = of_pixels(factors_, {pair.first, second});
      for (std::size_t k = 0; k < neuron_parts; ++k, ++neuron) {
        const Floats phase = hn::Mul(g, neuron->by_phase), along = hn::Mul(g, neuron->by_along);
        by_x[k] = hn::MulAdd(along, at.x, hn::MulAdd(phase, at.middle.x, by_x[k]));
        by_y[k] = hn::MulAdd(along, at.y, hn::MulAdd(phase, at.middle.y, by_y[k]));
        by_z[k] = hn::Add(along, hn::MulAdd(phase, at.middle.z, by_z[k]));
        by_phase[k] = hn::Add(by_phase[k], phase);
        by_amplitude[k] = hn::MulAdd(g, neuron->by_amplitude, by_amplitude[k]);
      }
    });
    float* out = moments;
    for (const Floats* sums : {by_x, by_y, by_z, by_phase, by_amplitude}) {
      for (std::size_t k = 0; k < neuron_parts; ++k) add_pixels(sums[k], out + k * neuron_lanes);
      out += neurons;
    }
  }

 private:
  /// Of each neuron, the derivatives of the density's mean over the chord: by its amplitude, its
  /// phase, and through the frequency along the ray.
  struct Neuron {
    Floats by_amplitude, by_phase, by_along;
  };
  static_assert(moment::frequencies == 0 && moment::phases == 3 * neurons &&
                moment::amplitudes == 4 * neurons);

  template <class Tag = FloatTag>
  HWY_INLINE void store_sums(PixelPair pair, Floats density, Floats ends, Floats by_middle) {
#if HWY_TARGET != HWY_SCALAR
    const Floats groups = sums_in_groups(density, ends, by_middle, hn::Zero(d));
    const hn::CappedTag<float, 4> d4;
    if constexpr (pixels_together == 2) {
      const hn::Half<Tag> half;
      hn::Store(sum_of_groups(hn::UpperHalf(half, groups)), d4, sums_ + 4 * pair.second);
      hn::Store(sum_of_groups(hn::LowerHalf(half, groups)), d4, sums_ + 4 * pair.first);
    } else {
      hn::Store(sum_of_groups(groups), d4, sums_ + 4 * pair.first);
    }
#else
    (void)pair;
    hn::Store(density, d, sums_), hn::Store(ends, d, sums_ + 1), hn::Store(by_middle, d, sums_ + 2);
#endif
  }

  /// Adds the values of both pixels of a pair.
  template <class Tag = FloatTag>
  static HWY_INLINE void add_pixels(Floats values, float* sums) {
#if HWY_TARGET != HWY_SCALAR
    if constexpr (pixels_together == 2) {
      const hn::Half<Tag> half;
      const auto both = hn::Add(hn::LowerHalf(half, values), hn::UpperHalf(half, values));
      return hn::Store(hn::Add(hn::Load(half, sums), both), half, sums);
    }
#endif
    hn::Store(hn::Add(hn::Load(d, sums), values), d, sums);
  }

  NeuronChords chords_;
  unsigned pixels_;
  alignas(64) float factors_[2 * lanes];
  alignas(64) float sums_[4 * lanes];  // density, ends, by_middle and 0 of each pixel
  Neuron neurons_[lanes / pixels_together * neuron_parts];
};

/// Sums over the pixels of a block without those of the network, lane by lane. Where a vector has
/// all pixels, they are its values.
struct BlockSums {
  static constexpr std::size_t first = moment::offset;
  Floats values[moment::count - first];

  HWY_INLINE BlockSums() {
    for (std::size_t k = parts > 1 ? first : std::size_t(moment::evident); k < moment::count; ++k)
      values[k - first] = hn::Zero(d);
  }
  HWY_INLINE void add(std::size_t place, Floats value) {
    Floats& sum = values[place - first];
    sum = parts > 1 ? hn::Add(sum, value) : value;
  }
  HWY_INLINE void add_to(float* moments) const {
    for (std::size_t k = first; k < moment::count; k += 4)
      add_lanes(values + k - first, moments + k);
  }
};

/// An entry at a vector of a block's pixels.
struct EntryAgain {
  DensityChord chord;
  NeuronsAgain network;
};

/// Blends an entry again, and adds its derivatives at a vector of a block's pixels, but for those
/// by the network.
HWY_INLINE void replay(const Densities& kernel, const NeuralEntry& entry, Floats length,
                       BlockGradient& block, std::size_t part, EntryAgain& at, BlockSums& sums) {
  const DensityChord& chord = at.chord;
  const Floats offset = constant(entry.offset);
  Floats density, ends, by_middle;
  at.network.read(density, ends, by_middle);
  const Floats scale = hn::Mul(constant(entry.twice_by_largest), length);
  const Floats by_density = hn::Mul(scale, chord.half);
  const Floats unlimited = one_minus_exp_of(hn::Mul(by_density, hn::Add(offset, density)));
  const Mask covered = hn::And(chord.exists, hn::Ge(unlimited, constant(kernel.view.min_alpha)));
  const Again seen = again(kernel.view, entry, covered, unlimited, block, part);
  const Floats weight = seen.weight;
  // dL/dtau = dL/dalpha (1 - alpha), since 1 - alpha = exp(-tau).
  const Floats by_depth =
      hn::IfThenElseZero(seen.moves, hn::MulSub(seen.after, seen.along, block.behind[part]));
  const Floats g = hn::Mul(by_depth, by_density);
  at.network.set_factor(g);
  sums.add(moment::offset, g);

  // By half of the chord's length and by its middle. Where the near plane is its beginning, only
  // its end moves: by the sum of both, half each.
  Floats by_half = hn::Mul(by_depth, hn::Mul(scale, hn::Add(offset, ends)));
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
}

/// Entries whose stages are computed together, each for all of them: what one stage computes late,
/// the next one of the same entry would wait for.
constexpr std::size_t replayed_batch = 4;

/// Lines of TileScratch for the sums of an entry.
constexpr std::size_t lines_an_entry = (sizeof(NeuralMoments) - 1) / sizeof(TileLine) + 1;

/// TileFunctions::blend_backward. A pair has so many sums that each block adds its own to memory:
/// that of the tile, which is in the cache.
void blend_densities_backward(const ImageView& view, std::span<const NeuralEntry> entries,
                              std::span<const std::uint32_t> tile,
                              std::span<const std::uint32_t> numbers, const TileRecord& record,
                              const TileGradient& gradient, TileScratch& scratch,
                              std::span<NeuralMoments> moments) {
  const Densities kernel(view, 0);
  if (scratch.lines.size() < lines_an_entry * tile.size())
    scratch.lines.resize(lines_an_entry * tile.size());
  std::fill_n(scratch.lines.begin(), lines_an_entry * tile.size(), TileLine{});
  const auto sums_at = [&](std::size_t place) {
    return scratch.lines[lines_an_entry * place].values;
  };
  EntryAgain again[replayed_batch][parts];
  for (int i = 0; i < blocks_a_tile; ++i) {
    const std::uint32_t begin = i == 0 ? 0 : record.ends[i - 1], end = record.ends[i];
    if (begin == end) continue;
    BlockGradient block(gradient, i);
    Floats length[parts];
    for (std::size_t part = 0; part < parts; ++part)
      length[part] =
          ray_length(kernel.camera.ray_x(block.x[part]), kernel.camera.ray_y(block.y[part]));
    for (std::uint32_t first = begin; first < end; first += replayed_batch) {
      const std::size_t count = std::min<std::size_t>(replayed_batch, end - first);
      const auto place_of = [&](std::size_t e) {
        return record.blended[first + e] & ~TileRecord::evident_bit;
      };
      const auto entry_of = [&](std::size_t e) -> const NeuralEntry& {
        return entries[tile[place_of(e)] & place_mask];
      };
      for (std::size_t e = 0; e < count; ++e)
        for (std::size_t part = 0; part < parts; ++part) {
          DensityChord& chord = again[e][part].chord;
          chord = kernel.chord_of(entry_of(e), block.x[part], block.y[part]);
          chord.exists = hn::And(chord.exists, hn::Gt(block.transmittance[part], hn::Zero(d)));
        }
      for (std::size_t e = 0; e < count; ++e)
        for (std::size_t part = 0; part < parts; ++part) {
          const DensityChord& chord = again[e][part].chord;
          again[e][part].network.compute(entry_of(e), chord, bits_of(d, chord.exists));
        }
      for (std::size_t e = 0; e < count; ++e) {
        BlockSums sums;
        for (std::size_t part = 0; part < parts; ++part)
          replay(kernel, entry_of(e), length[part], block, part, again[e][part], sums);
        float* out = sums_at(place_of(e));
        sums.add_to(out);
        if (record.blended[first + e] & TileRecord::evident_bit) out[moment::evident] += 1;
      }
      for (std::size_t e = 0; e < count; ++e)
        for (std::size_t part = 0; part < parts; ++part)
          again[e][part].network.add_to(sums_at(place_of(e)));
    }
  }
  for (std::size_t k = 0; k < numbers.size(); ++k)
    std::memcpy(&moments[numbers[k]], sums_at(k), sizeof(NeuralMoments));
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
