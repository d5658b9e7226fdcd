#include "scene/edit/lattice_levels.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <map>
#include <memory>
#include <tuple>

#include "base/error.hpp"
#include "image/quantise.hpp"
#include "scene/edit/lattice_projection.hpp"
#include "scene/lattice.hpp"

namespace tureen {

namespace {

constexpr int channels = LatticeTexture::channels;

/// One face's texels as floats, with features and alpha separate, as arguments of projections.
struct FaceTexels {
  std::vector<float> features, alpha;

  explicit FaceTexels(int level)
      : features(lattice::texel_count(level) * LatticeTexture::features),
        alpha(lattice::texel_count(level)) {}

  static FaceTexels of(const LatticeTexture& texture, const LatticePatch& patch) {
    FaceTexels result{int(patch.level)};
    const auto finite = [](float value) { return std::isfinite(value) ? value : 0.0f; };
    for (std::size_t i = 0; i < result.alpha.size(); ++i) {
      for (int c = 0; c < LatticeTexture::features; ++c)
        result.features[i * LatticeTexture::features + c] =
            finite(texture.value(patch.first_texel + i, c));
      result.alpha[i] = finite(texture.value(patch.first_texel + i, LatticeTexture::features));
    }
    return result;
  }
};

/// One projection for each pair of levels, created on first use.
class Projections {
 public:
  const LatticeProjection& get(int from, int to) {
    auto& kept = all_[std::size_t(from)][std::size_t(to)];
    if (!kept) kept = std::make_unique<LatticeProjection>(from, to);
    return *kept;
  }

 private:
  static constexpr std::size_t levels = lattice::max_level + 1;
  std::array<std::array<std::unique_ptr<LatticeProjection>, levels>, levels> all_;
};

FaceTexels projected(const LatticeProjection& projection, const FaceTexels& fine) {
  FaceTexels coarse(projection.to());
  projection.project(LatticeTexture::features, fine.features, coarse.features);
  for (float& value : coarse.features) value = std::clamp(value, 0.0f, 1.0f);
  projection.project_alpha(fine.alpha, coarse.alpha);
  return coarse;
}

/// Limits progress to about 100 calls (below 200), independent of the number of faces.
class Pace {
 public:
  Pace(const LevelProgress& progress, std::size_t count) : progress_(progress), count_(count) {}
  void at(std::size_t i) const {
    if (progress_ && i % std::max<std::size_t>(count_ / 100, 1) == 0)
      progress_(double(i) / double(count_));
  }

 private:
  const LevelProgress& progress_;
  std::size_t count_;
};

template <class Value>
Value stored(float value, bool is_alpha) {
  if constexpr (std::is_same_v<Value, std::uint8_t>)
    return is_alpha ? quantised_alpha(value) : quantised_unit(value);
  else
    return value;
}

template <class Value>
LatticeTexture with_levels(const LatticeTexture& texture, const std::vector<Value>& values,
                           std::span<const std::uint8_t> levels, const LevelProgress& progress) {
  LatticeTexture result;
  result.mlp = texture.mlp;
  std::vector<Value> texels;
  std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint8_t>, std::uint32_t> known;
  Projections projections;
  const Pace pace(progress, levels.size());
  for (std::size_t t = 0; t < levels.size(); ++t) {
    pace.at(t);
    const LatticePatch& patch = texture.patches[t];
    assert(levels[t] <= patch.level);
    const std::size_t first = texels.size() / channels;
    if (first + lattice::texel_count(levels[t]) > std::numeric_limits<std::uint32_t>::max())
      throw UsageError(
          "faces share some of their texels; with separate texels for each face, the number of "
          "texels would exceed 32 bits");
    const auto [place, is_new] =
        known.try_emplace({patch.first_texel, patch.level, levels[t]}, std::uint32_t(first));
    result.patches.push_back({place->second, levels[t]});
    if (!is_new) continue;
    if (levels[t] == patch.level) {
      const auto begin = values.begin() + std::ptrdiff_t(patch.first_texel) * channels;
      texels.insert(texels.end(), begin,
                    begin + std::ptrdiff_t(lattice::texel_count(levels[t])) * channels);
      continue;
    }
    const FaceTexels coarse =
        projected(projections.get(int(patch.level), levels[t]), FaceTexels::of(texture, patch));
    for (std::size_t i = 0; i < coarse.alpha.size(); ++i) {
      for (int c = 0; c < LatticeTexture::features; ++c)
        texels.push_back(stored<Value>(coarse.features[i * LatticeTexture::features + c], false));
      texels.push_back(stored<Value>(coarse.alpha[i], true));
    }
  }
  result.texels = std::move(texels);
  return result;
}

}  // namespace

std::vector<std::uint8_t> smallest_levels(const LatticeTexture& texture,
                                          const LevelTolerance& tolerance,
                                          const LevelProgress& progress) {
  const int compared = texture.mlp ? LatticeTexture::features : 3;
  std::vector<std::uint8_t> levels;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint8_t> known;
  Projections projections;
  const Pace pace(progress, texture.patches.size());
  for (const LatticePatch& patch : texture.patches) {
    pace.at(levels.size());
    const auto [place, is_new] =
        known.try_emplace({patch.first_texel, patch.level}, std::uint8_t(patch.level));
    if (is_new) {
      const FaceTexels fine = FaceTexels::of(texture, patch);
      const bool unseen = std::all_of(fine.alpha.begin(), fine.alpha.end(),
                                      [](float alpha) { return alpha < alpha_threshold; });
      const auto keeps_within = [&](int level) {
        if (unseen) return true;
        const LatticeProjection& projection = projections.get(int(patch.level), level);
        const FaceTexels coarse = projected(projection, fine);
        const auto error =
            projection.error(LatticeTexture::features, compared, fine.features, coarse.features);
        return error.largest <= tolerance.largest &&
               std::sqrt(error.squared) <= tolerance.root_mean_square &&
               projection.coverage_mismatch(fine.alpha, coarse.alpha) <= tolerance.coverage;
      };
      int level = 0;
      while (level < int(patch.level) && !keeps_within(level)) ++level;
      place->second = std::uint8_t(level);
    }
    levels.push_back(place->second);
  }
  return levels;
}

LatticeTexture at_levels(const LatticeTexture& texture, std::span<const std::uint8_t> levels,
                         const LevelProgress& progress) {
  assert(levels.size() == texture.patches.size());
  return std::visit(
      [&](const auto& values) { return with_levels(texture, values, levels, progress); },
      texture.texels);
}

LatticeTexture at_most_level(const LatticeTexture& texture, int level,
                             const LevelProgress& progress) {
  std::vector<std::uint8_t> levels;
  for (const LatticePatch& patch : texture.patches)
    levels.push_back(std::uint8_t(std::min(int(patch.level), level)));
  return at_levels(texture, levels, progress);
}

}  // namespace tureen
