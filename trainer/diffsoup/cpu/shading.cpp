#include "trainer/diffsoup/cpu/shading.hpp"

#include <cmath>
#include <cstring>

#include "scene/lattice.hpp"
#include "scene/triangle_soup.hpp"
#include "trainer/common/cpu/vector_clones.hpp"
#include "trainer/common/kernels/pack.hpp"
#include "trainer/diffsoup/kernels/color_network.hpp"
#include "trainer/diffsoup/kernels/texel_pack.hpp"

namespace tureen::trainer {

namespace {

constexpr int lanes = kernels::pack_lanes;
using kernels::Pack;
using State = kernels::NetworkState<Pack>;

/// Pixels with a visible face, one per lane.
struct Batch {
  std::size_t pixel[lanes];
  int x[lanes], y[lanes];
  int count = 0;
};

/// The texture of a pixel's visible face.
[[gnu::always_inline]] inline const Texel* texture_of(const VisiblePixel& visible,
                                                      const ShadingInput& input) {
  return input.texture + visible.face * std::size_t(lattice::texel_count(input.level));
}

/// The features of a pixel's visible face.
[[gnu::always_inline]] inline kernels::TexelPack features_at(const VisiblePixel& visible,
                                                             const ShadingInput& input) {
  const auto at = lattice::footprint(input.level, visible.b0, visible.b1);
  const auto texel = [&](std::size_t j) __attribute__((always_inline)) {
    return kernels::load_texel(texture_of(visible, input)[at.texels[j]].values);
  };
  return lattice::interpolated(at.weights, texel(0), texel(1), texel(2));
}

/// Loads the texels of a row into the cache. Without this, waiting for them takes half the time.
[[gnu::always_inline]] inline void prefetch_row(const BatchImage& image, const ShadingInput& input,
                                                int y) {
  const VisiblePixel* row = &image.visible[std::size_t(y) * std::size_t(image.view.width)];
  for (int x = 0; x < image.view.width; ++x) {
    if (row[x].face == no_face) continue;
    const auto at = lattice::footprint(input.level, row[x].b0, row[x].b1);
    for (const std::uint32_t texel : at.texels)
      __builtin_prefetch(texture_of(row[x], input) + texel);
  }
}

/// The network's input: features of the pixels, harmonics of the direction to the eye. Lanes
/// without a pixel repeat the first one. `features` returns those of a pixel.
template <class Features>
[[gnu::always_inline]] inline void gather(const BatchImage& image, const Batch& batch,
                                          const Features& features, State& state) {
  const kernels::View& view = image.view;
  alignas(64) float inputs[channels][lanes];
  alignas(64) float pixel_x[lanes], pixel_y[lanes];
  for (int l = 0; l < lanes; ++l) {
    const int source = l < batch.count ? l : 0;
    const std::size_t pixel = batch.pixel[source];
    const kernels::TexelPack values = features(pixel);
    for (int f = 0; f < channels; ++f) inputs[f][l] = values[f];
    pixel_x[l] = float(batch.x[source]);
    pixel_y[l] = float(batch.y[source]);
  }
  for (int f = 0; f < kernels::features; ++f) std::memcpy(&state.input[f], inputs[f], sizeof(Pack));
  Pack x, y;
  std::memcpy(&x, pixel_x, sizeof x);
  std::memcpy(&y, pixel_y, sizeof y);
  x = (x + float(0.5 - view.cx)) * float(1 / view.fx);
  y = (y + float(0.5 - view.cy)) * float(1 / view.fy);
  Pack direction[3];
  for (int i = 0; i < 3; ++i)
    direction[i] = -(x * float(view.right[i]) + y * float(view.down[i]) + float(view.forward[i]));
  const Pack squared =
      direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2];
  Pack scale;
  for (int l = 0; l < lanes; ++l) scale[l] = 1 / std::sqrt(squared[l]);
  kernels::harmonics9<Pack>(direction[0] * scale, direction[1] * scale, direction[2] * scale,
                            state.input + kernels::features);
}

/// Finds the lanes with finite features and sets the features of all others to 0. NaN and infinity
/// would reach the network's gradient even times zero.
[[gnu::always_inline]] inline void quarantine(State& state, kernels::IntPack& finite) {
  finite = Pack{} == Pack{};
  for (int f = 0; f < kernels::features; ++f) finite &= state.input[f] * 0.0f == 0.0f;
  for (int f = 0; f < kernels::features; ++f) state.input[f] = finite ? state.input[f] : Pack{};
}

/// Calls visit(batch) for all pixels of the rows with a visible face. The last batch may not be
/// full.
template <class Visitor>
[[gnu::always_inline]] inline void for_each_batch(const BatchImage& image, int y0, int y1,
                                                  Visitor&& visit) {
  Batch batch;
  for (int y = y0; y < y1; ++y)
    for (int x = 0; x < image.view.width; ++x) {
      const std::size_t pixel = std::size_t(y) * image.view.width + x;
      if (image.visible[pixel].face == no_face) continue;
      batch.pixel[batch.count] = pixel;
      batch.x[batch.count] = x;
      batch.y[batch.count] = y;
      if (++batch.count == lanes) {
        visit(batch);
        batch.count = 0;
      }
    }
  if (batch.count) visit(batch);
}

}  // namespace

TUREEN_VECTOR_CLONES TUREEN_FLATTEN void shade_rows(BatchImage& image, const ShadingInput& input,
                                                    int y0, int y1) {
  const std::size_t pixels = image.pixels();
  const std::size_t begin = std::size_t(y0) * image.view.width;
  const std::size_t end = std::size_t(y1) * image.view.width;
  for (int c = 0; c < 3; ++c)
    for (std::size_t p = begin; p < end; ++p) image.color[c * pixels + p] = input.background[c];
  const bool stores_features = !image.features.empty();
  int prefetched = y0;  // the next row
  for_each_batch(
      image, y0, y1, [&](const Batch& batch) __attribute__((always_inline)) {
        for (; prefetched < y1 && prefetched <= batch.y[batch.count - 1] + 1; ++prefetched)
          prefetch_row(image, input, prefetched);
        State state;
        gather(
            image, batch,
            [&](std::size_t pixel) __attribute__((always_inline)) {
              const kernels::TexelPack features = features_at(image.visible[pixel], input);
              if (stores_features) kernels::store_texel(image.features[pixel].values, features);
              return features;
            },
            state);
        Pack color[3];
        kernels::shade(input.mlp->data(), state, color);
        for (int c = 0; c < 3; ++c)
          for (int l = 0; l < batch.count; ++l)
            image.color[c * pixels + batch.pixel[l]] = color[c][l];
      });
}

TUREEN_VECTOR_CLONES TUREEN_FLATTEN void shade_rows_backward(BatchImage& image,
                                                             const ShadingInput& input, int y0,
                                                             int y1, MlpParameters& mlp_gradient) {
  const std::size_t pixels = image.pixels();
  Pack sums[mlp_parameters] = {};
  for_each_batch(
      image, y0, y1, [&](const Batch& batch) __attribute__((always_inline)) {
        State state;
        gather(
            image, batch,
            [&](std::size_t pixel) __attribute__((always_inline)) {
              return kernels::load_texel(image.features[pixel].values);
            },
            state);
        kernels::IntPack finite;
        quarantine(state, finite);
        Pack color[3], dcolor[3];
        kernels::shade(input.mlp->data(), state, color);
        for (int c = 0; c < 3; ++c) {
          alignas(64) float by_color[lanes] = {};
          for (int l = 0; l < batch.count; ++l)
            by_color[l] = image.by_color[c * pixels + batch.pixel[l]];
          std::memcpy(&dcolor[c], by_color, sizeof(Pack));
          dcolor[c] = finite ? dcolor[c] : Pack{};
        }
        Pack dfeatures[kernels::features];
        kernels::shade_backward(input.mlp->data(), state, dcolor, sums, dfeatures);
        for (int l = 0; l < batch.count; ++l) {
          float* out = image.features[batch.pixel[l]].values;
          for (int f = 0; f < kernels::features; ++f) out[f] = dfeatures[f][l];
          if (input.half_scale != 0)
            for (int f = 0; f < kernels::features; ++f)
              out[f] = kernels::rounded_to_half(out[f] * input.half_scale) / input.half_scale;
          out[alpha_channel] = 0;
        }
      });
  for (int i = 0; i < mlp_parameters; ++i) {
    float sum = 0;
    for (int l = 0; l < lanes; ++l) sum += sums[i][l];
    mlp_gradient[std::size_t(i)] = sum;
  }
}

}  // namespace tureen::trainer
