#include "scene/edit/baked_color.hpp"

#include <algorithm>
#include <array>

#include "image/quantise.hpp"
#include "scene/edit/mean_mlp.hpp"
#include "scene/lattice.hpp"

namespace tureen {

namespace {

/// Whether each texel is a corner of a triangle with visible points, i.e. with an alpha of at least
/// alpha_threshold at any corner.
std::vector<bool> texels_that_show(const LatticeTexture& texture) {
  std::vector<bool> shows(texture.texel_count(), false);
  for (const LatticePatch& patch : texture.patches) {
    const auto visible = [&](std::size_t texel) {
      return texture.value(patch.first_texel + texel, LatticeTexture::features) >= alpha_threshold;
    };
    lattice::for_each_triangle(int(patch.level), [&](std::size_t a, std::size_t b, std::size_t c) {
      if (visible(a) || visible(b) || visible(c))
        for (const std::size_t texel : {a, b, c}) shows[patch.first_texel + texel] = true;
    });
  }
  return shows;
}

}  // namespace

LatticeTexture baked_color(const LatticeTexture& texture,
                           const std::function<void(double)>& progress) {
  if (!texture.mlp) return texture;
  constexpr int channels = LatticeTexture::channels;
  const MeanMlp mean(*texture.mlp);
  const std::vector<bool> shows = texels_that_show(texture);
  const auto baked = [&]<class Value>(const std::vector<Value>& values) {
    std::vector<Value> result(values.size(), Value(0));
    for (std::size_t texel = 0; texel < shows.size(); ++texel) {
      if (progress && texel % 16384 == 0) progress(double(texel) / double(shows.size()));
      const Value* from = &values[texel * channels];
      Value* to = &result[texel * channels];
      to[LatticeTexture::features] = from[LatticeTexture::features];
      std::copy_n(from, 3, to);
      if (!shows[texel]) continue;
      std::array<float, 8> features;
      for (int c = 0; c < channels; ++c) features[std::size_t(c)] = texture.value(texel, c);
      const glm::vec3 color = mean(features);
      for (int k = 0; k < 3; ++k) {
        if constexpr (sizeof(Value) == 1)
          to[k] = quantised_unit(color[k]);
        else
          to[k] = std::clamp(color[k], 0.0f, 1.0f);
      }
    }
    return result;
  };
  LatticeTexture result;
  result.patches = texture.patches;
  std::visit([&](const auto& values) { result.texels = baked(values); }, texture.texels);
  return result;
}

LatticeTexture base_color(LatticeTexture texture) {
  texture.mlp.reset();
  return texture;
}

}  // namespace tureen
