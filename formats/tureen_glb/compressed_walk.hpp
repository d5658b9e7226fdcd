// The traversal of a compressed file's texels, shared by encoder and decoder: the order of the
// coded values and their probability models. Internal to compressed_texels_*.cpp.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "formats/tureen_glb/compressed_texels.hpp"
#include "formats/tureen_glb/range_coder.hpp"
#include "scene/lattice.hpp"

namespace tureen::compressed {

inline constexpr int channels = LatticeTexture::channels;
inline constexpr int alpha = LatticeTexture::features;
/// Largest number of texels and faces per stored byte. Each needs at most 60 bytes of temporary
/// memory, so the total stays within 4,096 bytes per byte. The encoder pads smaller data, so a
/// small file cannot request much memory.
inline constexpr std::uint64_t max_per_byte = 64;

/// A texel that a level adds to the next coarser one, and its two neighbours, in the coordinates of
/// the finer level.
struct Middle {
  lattice::Coordinates at, a, b;
};

/// The middles of a level, 1..lattice::max_level, diagonal by diagonal.
const std::vector<Middle>& middles(int level);

/// Index in the patch of a texel on a level that is `shift` levels coarser.
inline std::uint32_t index_of(lattice::Coordinates c, int shift) {
  return lattice::texel_index(c.x << shift, c.y << shift);
}

/// Properties of a patch that precede its texels.
struct Patch {
  std::uint32_t first_texel = 0;
  std::uint8_t level = 0;
  std::uint8_t coarseness = one_step;
};

/// The patches of a stream, and the patch index of each face.
struct Faces {
  std::vector<Patch> patches;
  std::vector<std::uint32_t> patch_of_face;
  std::uint64_t texels = 0;
};

struct Steps {
  int features = 1;
  int alpha = 1;
};

/// The probability models of the whole stream.
struct Models {
  static constexpr int nearby = 12, others = 4;
  /// Models of the residual: its size by nearby residuals and those of the texel's other channels,
  /// and its sign by that of another channel.
  struct Miss {
    BitModel zero[nearby][others];
    BitModel negative[nearby][3];
    NumberModel<17> size[nearby];  // values have 16 bits
  };
  Miss miss[channels][lattice::max_level + 1];
  BitModel shared;
  BitModel level[8][8];
  BitModel coarseness[8][8];
  NumberModel<25> distance;
};

/// Three bits. Each probability depends on the preceding bits and on the last value.
template <class Coder>
std::uint8_t three_bits(Coder& coder, BitModel (&models)[8][8], unsigned last, unsigned value) {
  unsigned node = 1;
  for (int i = 2; i >= 0; --i)
    node = node << 1 | unsigned(coder.bit(models[last][node], int(value >> i & 1u)));
  return static_cast<std::uint8_t>(node & 7u);
}

/// Codes the level and coarseness of each patch, and the patch of each of `count` faces. A decoder
/// passes an empty `given`. Returns false if the bytes name a missing patch or exceed
/// `texel_limit`.
template <class Coder>
bool code_faces(Coder& coder, Models& models, std::size_t count, const Faces& given,
                std::uint64_t texel_limit, Faces& result) {
  unsigned last_level = 0, last_coarseness = one_step;
  for (std::size_t t = 0; t < count; ++t) {
    const std::size_t known = result.patches.size();
    const std::size_t wanted = given.patch_of_face.empty() ? 0 : given.patch_of_face[t];
    if (coder.bit(models.shared, wanted < known)) {
      const std::size_t back = wanted < known ? known - 1 - wanted : 0;
      const std::uint32_t distance = models.distance.code(coder, std::uint32_t(back));
      if (distance >= known) return false;
      result.patch_of_face.push_back(std::uint32_t(known - 1 - distance));
      continue;
    }
    Patch patch = given.patches.empty() ? Patch{} : given.patches[wanted];
    patch.level = three_bits(coder, models.level, last_level, patch.level);
    patch.coarseness = three_bits(coder, models.coarseness, last_coarseness, patch.coarseness);
    last_level = patch.level;
    last_coarseness = patch.coarseness;
    patch.first_texel = std::uint32_t(result.texels);
    result.texels += lattice::texel_count(patch.level);
    if (result.texels > texel_limit) return false;
    result.patch_of_face.push_back(std::uint32_t(known));
    result.patches.push_back(patch);
  }
  return true;
}

/// A value to be coded.
struct Question {
  std::size_t texel;
  int channel;
  int finer_levels;  // of the patch, predicted from this value
  int prediction;
  int step;
};

/// Codes all values of all patches. `choose(question, price)` returns the residual in steps;
/// price(steps) is its cost in bits. A decoder ignores the result.
template <class Coder, class Choose>
class Walk {
 public:
  Walk(Coder& coder, Models& models, Steps steps, const Choose& choose)
      : coder_(coder), models_(models), steps_(steps), choose_(choose) {}

  /// Returns `channels` values a texel.
  std::vector<std::int16_t> operator()(const Faces& faces) {
    values_.resize(std::size_t(faces.texels) * channels);
    missed_.resize(values_.size());
    activity_.resize(faces.patches.size());
    Values last{};
    last[alpha] = 128;
    for (std::size_t p = 0; p < faces.patches.size(); ++p)
      last = corners(faces.patches[p], activity_[p], last);
    for (int level = 1; level <= lattice::max_level; ++level)
      for (std::size_t p = 0; p < faces.patches.size(); ++p)
        if (faces.patches[p].level >= level) finer(faces.patches[p], activity_[p], level);
    return std::move(values_);
  }

 private:
  using Values = std::array<int, channels>;

  /// Sum of the residual magnitudes in a patch so far, for each channel.
  struct Activity {
    std::array<std::int32_t, channels> missed{};
    std::int32_t texels = 0;
  };

  static int half(int sum) { return (sum + 1) >> 1; }

  Values corners(const Patch& patch, Activity& activity, const Values& last) {
    const int n = lattice::resolution(patch.level);
    const std::array<std::size_t, 3> at{patch.first_texel,
                                        patch.first_texel + lattice::texel_index(n, 0),
                                        patch.first_texel + lattice::texel_index(0, n)};
    Values before{};
    for (std::size_t k = 0; k < 3; ++k) {
      Values predictions;
      for (int c = 0; c < channels; ++c)
        predictions[std::size_t(c)] = k == 0   ? last[std::size_t(c)]
                                      : k == 1 ? value(at[0], c)
                                               : half(value(at[0], c) + value(at[1], c));
      texel({patch, activity, 0, at[k]}, predictions, {}, before);
    }
    Values mean;
    for (int c = 0; c < channels; ++c)
      mean[std::size_t(c)] = (value(at[0], c) + value(at[1], c) + value(at[2], c)) / 3;
    return mean;
  }

  void finer(const Patch& patch, Activity& activity, int level) {
    const int shift = patch.level - level;
    Values before{};
    for (const Middle& middle : middles(level)) {
      const std::size_t a = patch.first_texel + index_of(middle.a, shift);
      const std::size_t b = patch.first_texel + index_of(middle.b, shift);
      Values predictions, parents;
      for (int c = 0; c < channels; ++c) {
        predictions[std::size_t(c)] = half(value(a, c) + value(b, c));
        parents[std::size_t(c)] = missed(a, c) + missed(b, c);
      }
      texel({patch, activity, level, patch.first_texel + index_of(middle.at, shift)}, predictions,
            parents, before);
    }
  }

  struct TexelPosition {
    const Patch& patch;
    Activity& activity;
    int level;
    std::size_t texel;
  };

  /// `parents`: residuals of the two neighbours; `before`: weighted residuals of the preceding
  /// texels on this level, with more weight on recent ones.
  void texel(const TexelPosition& at, const Values& predictions, const Values& parents,
             Values& before) {
    Activity& activity = at.activity;
    int others = 0, sign = 0;
    // Alpha first: it determines the visibility of the features.
    for (int k = 0; k < channels; ++k) {
      const int c = k == 0 ? alpha : k - 1;
      const auto i = std::size_t(c);
      const int nearby =
          2 * before[i] + 2 * parents[i] + 8 * activity.missed[i] / std::max(activity.texels, 1);
      const Context context{models_.miss[c][at.level], twelve_kinds(nearby), four_kinds(others),
                            c == alpha ? 0 : sign};
      const int step = step_of(at.patch, c);
      const auto price = [&](int steps) {
        BitPrice bits;
        code(bits, context, steps);
        return bits.bits();
      };
      const int finer = at.patch.level - at.level;
      const int miss =
          code(coder_, context, choose_({at.texel, c, finer, predictions[i], step}, price));
      values_[at.texel * channels + i] = moved(c, predictions[i], miss * step);
      const int size = std::min(std::abs(miss), 255);
      missed_[at.texel * channels + i] = std::uint8_t(size);
      activity.missed[i] += std::min(size, 16);
      before[i] = (before[i] + 1) / 2 + std::min(size, 8);
      if (c == alpha) continue;
      others = others / 2 + std::min(size, 8);
      sign = miss == 0 ? sign : miss < 0 ? 1 : 2;
    }
    ++activity.texels;
  }

  static int twelve_kinds(int missed) {
    static constexpr int tops[] = {0, 2, 4, 6, 9, 12, 16, 22, 30, 42, 60};
    int kind = 0;
    while (kind < Models::nearby - 1 && missed > tops[kind]) ++kind;
    return kind;
  }
  static int four_kinds(int missed) {
    return missed == 0 ? 0 : missed <= 2 ? 1 : missed <= 6 ? 2 : 3;
  }

  int step_of(const Patch& patch, int c) const {
    if (c == alpha) return steps_.alpha;
    return std::max(steps_.features * compress_multipliers[patch.coarseness] / 4, 1);
  }

  static std::int16_t moved(int c, int prediction, int by) {
    const int low = c == alpha ? 0 : -32768, high = c == alpha ? 255 : 32767;
    return static_cast<std::int16_t>(std::clamp(prediction + by, low, high));
  }

  struct Context {
    Models::Miss& models;
    int nearby, others, sign;
  };

  template <class AnyCoder>
  static int code(AnyCoder& coder, const Context& context, int miss) {
    Models::Miss& models = context.models;
    if (!coder.bit(models.zero[context.nearby][context.others], miss != 0)) return 0;
    const bool negative = coder.bit(models.negative[context.nearby][context.sign], miss < 0);
    const auto more = std::uint32_t(std::max(std::abs(miss) - 1, 0));
    const int size = 1 + int(models.size[context.nearby].code(coder, more));
    return negative ? -size : size;
  }

  int value(std::size_t texel, int c) const { return values_[texel * channels + std::size_t(c)]; }
  int missed(std::size_t texel, int c) const { return missed_[texel * channels + std::size_t(c)]; }

  Coder& coder_;
  Models& models_;
  const Steps steps_;
  const Choose& choose_;
  std::vector<std::int16_t> values_;
  std::vector<std::uint8_t> missed_;
  std::vector<Activity> activity_;
};

}  // namespace tureen::compressed
