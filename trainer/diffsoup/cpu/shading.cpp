#include "trainer/diffsoup/cpu/shading.hpp"

#include <array>
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
using kernels::IntPack;
using kernels::Pack;
using kernels::TexelPack;
using State = kernels::NetworkState<Pack>;

/// Pixels with a visible face, one per lane. Lanes without a pixel repeat the first one.
struct Batch {
  int count = 0;
  std::size_t pixel[lanes];
  alignas(64) float x[lanes], y[lanes];
};

/// Reads the pixels of rows with a visible face, batch by batch. The last may not be full.
class BatchReader {
 public:
  TUREEN_ALWAYS_INLINE BatchReader(const BatchImage& image, int y0, int y1)
      : image_(image), y_(y0), end_(y1) {}

  /// Returns false at the end.
  TUREEN_ALWAYS_INLINE bool next(Batch& batch) {
    batch.count = 0;
    const int width = image_.view.width;
    for (; y_ < end_ && batch.count < lanes; y_ += x_ == width, x_ = x_ == width ? 0 : x_) {
      const std::size_t row = std::size_t(y_) * std::size_t(width);
      for (; x_ < width && batch.count < lanes; ++x_) {
        if (image_.visible[row + std::size_t(x_)].face == no_face) continue;
        batch.pixel[batch.count] = row + std::size_t(x_);
        batch.x[batch.count] = float(x_);
        batch.y[batch.count++] = float(y_);
      }
    }
    if (batch.count == 0) return false;
    for (int l = batch.count; l < lanes; ++l) {
      batch.pixel[l] = batch.pixel[0];
      batch.x[l] = batch.x[0];
      batch.y[l] = batch.y[0];
    }
    return true;
  }

 private:
  const BatchImage& image_;
  int x_ = 0, y_, end_;
};

/// The texels of a batch and their weights, as by lattice::footprint().
struct Footprints {
  const float* texels[3][lanes];
  alignas(64) float weights[2][lanes];
};

TUREEN_ALWAYS_INLINE Pack load(const float (&values)[lanes]) {
  Pack result;
  std::memcpy(&result, values, sizeof result);
  return result;
}

/// lattice::texel_index(x, diagonal - x) of y = diagonal - x.
TUREEN_ALWAYS_INLINE IntPack texel_index(const IntPack& diagonal, const IntPack& y) {
  return ((diagonal * (diagonal + 1)) >> 1) + y;
}

/// Finds the footprints, and loads their texels into the cache.
TUREEN_ALWAYS_INLINE void find_footprints(const BatchImage& image, const ShadingInput& input,
                                          const Batch& batch, Footprints& out) {
  alignas(64) float b0[lanes], b1[lanes];
  const Texel* textures[lanes];
  const std::size_t texels = lattice::texel_count(input.level);
  for (int l = 0; l < lanes; ++l) {
    const VisiblePixel& visible = image.visible[batch.pixel[l]];
    b0[l] = visible.b0;
    b1[l] = visible.b1;
    textures[l] = input.texture + visible.face * texels;
  }
  const int n = lattice::resolution(input.level);
  Pack p = load(b0) * float(n), q = load(b1) * float(n);
  const auto cell = [](const Pack& value, const IntPack& upper) __attribute__((always_inline)) {
    const Pack limit = __builtin_convertvector(upper, Pack);
    Pack clamped = value > 0.0f ? value : Pack{};  // NaN gives 0
    clamped = clamped < limit ? clamped : limit;
    return __builtin_convertvector(clamped, IntPack);
  };
  const IntPack x = cell(p, IntPack{} + (n - 1));
  const IntPack y = cell(q, n - 1 - x);
  p -= __builtin_convertvector(x, Pack);
  q -= __builtin_convertvector(y, Pack);
  const IntPack upper = p + q > 1.0f, diagonal = x + y + 1;
  const IntPack limit = n - (x + 1);
  const IntPack corner_y = y + 1 < limit ? y + 1 : limit;
  const IntPack first = texel_index(diagonal, y);  // (x + 1, y); (x, y + 1) is the next
  const IntPack third =
      upper ? texel_index(x + 1 + corner_y, corner_y) : texel_index(diagonal - 1, y);
  const Pack w0 = upper ? 1.0f - q : p, w1 = upper ? 1.0f - p : q;
  std::memcpy(out.weights[0], &w0, sizeof w0);
  std::memcpy(out.weights[1], &w1, sizeof w1);
  alignas(64) std::int32_t texel[2][lanes];
  std::memcpy(texel[0], &first, sizeof first);
  std::memcpy(texel[1], &third, sizeof third);
  for (int l = 0; l < lanes; ++l) {
    out.texels[0][l] = textures[l][texel[0][l]].values;
    out.texels[1][l] = textures[l][texel[0][l] + 1].values;
    out.texels[2][l] = textures[l][texel[1][l]].values;
    for (int k = 0; k < 3; ++k) __builtin_prefetch(out.texels[k][l]);
  }
}

/// From eight rows of eight to their columns, and back.
TUREEN_ALWAYS_INLINE void transpose(const TexelPack (&in)[channels], TexelPack (&out)[channels]) {
  static_assert(channels == 8);
  TexelPack pairs[8], fours[8];
  for (int i = 0; i < 8; i += 2) {
    pairs[i] = __builtin_shufflevector(in[i], in[i + 1], 0, 8, 1, 9, 4, 12, 5, 13);
    pairs[i + 1] = __builtin_shufflevector(in[i], in[i + 1], 2, 10, 3, 11, 6, 14, 7, 15);
  }
  for (int i = 0; i < 8; i += 4)
    for (int j = 0; j < 2; ++j) {
      const TexelPack &a = pairs[i + j], &b = pairs[i + j + 2];
      fours[i + 2 * j] = __builtin_shufflevector(a, b, 0, 1, 8, 9, 4, 5, 12, 13);
      fours[i + 2 * j + 1] = __builtin_shufflevector(a, b, 2, 3, 10, 11, 6, 7, 14, 15);
    }
  for (int i = 0; i < 4; ++i) {
    out[i] = __builtin_shufflevector(fours[i], fours[i + 4], 0, 1, 2, 3, 8, 9, 10, 11);
    out[i + 4] = __builtin_shufflevector(fours[i], fours[i + 4], 4, 5, 6, 7, 12, 13, 14, 15);
  }
}

/// The network's input: features of the pixels, harmonics of the direction to the eye. `features`
/// returns those of a lane.
template <class Features>
TUREEN_ALWAYS_INLINE void gather(const kernels::View& view, const Batch& batch,
                                 const Features& features, State& state) {
  alignas(64) float inputs[channels][lanes];
  for (int half = 0; half < lanes; half += channels) {
    TexelPack rows[channels], columns[channels];
    for (int l = 0; l < channels; ++l) rows[l] = features(half + l);
    transpose(rows, columns);
    for (int f = 0; f < channels; ++f) kernels::store_texel(inputs[f] + half, columns[f]);
  }
  for (int f = 0; f < kernels::features; ++f) state.input[f] = load(inputs[f]);
  const Pack x = (load(batch.x) + float(0.5 - view.cx)) * float(1 / view.fx);
  const Pack y = (load(batch.y) + float(0.5 - view.cy)) * float(1 / view.fy);
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

/// Sets the features of all lanes with NaN or infinity to 0. Either would reach the network's
/// gradient even times zero. Returns 0 in the other lanes, and NaN there. (GCC computes masks of
/// packs lane by lane, but not selections.)
TUREEN_ALWAYS_INLINE Pack quarantine(State& state) {
  Pack zero = {};
  for (int f = 0; f < kernels::features; ++f) zero += state.input[f] * 0.0f;
  for (int f = 0; f < kernels::features; ++f)
    state.input[f] = zero < 1.0f ? state.input[f] : Pack{};
  return zero;
}

/// Stores the gradient of the features of each pixel.
TUREEN_ALWAYS_INLINE void store_gradient(BatchImage& image, const Batch& batch,
                                         const Pack (&dfeatures)[kernels::features],
                                         float half_scale) {
  alignas(64) float values[channels][lanes] = {};
  std::memcpy(values, dfeatures, sizeof dfeatures);
  if (half_scale != 0)
    for (int f = 0; f < kernels::features; ++f)
      for (float& value : values[f])
        value = kernels::rounded_to_half(value * half_scale) / half_scale;
  for (int half = 0; half < lanes; half += channels) {
    TexelPack columns[channels], rows[channels];
    for (int f = 0; f < channels; ++f) columns[f] = kernels::load_texel(values[f] + half);
    transpose(columns, rows);
    for (int l = 0; l < channels && half + l < batch.count; ++l)
      kernels::store_texel(image.features[batch.pixel[half + l]].values, rows[l]);
  }
}

/// A batch in the backward pass: the values of the layers, and the derivatives by what each layer
/// computes before its activation.
struct BackwardBatch {
  State state;
  Pack dy1[mlp_width], dy2[mlp_width], dy3[mlp_outputs];
};

/// Records what add_parameters() needs. The interface of kernels::AddedDerivatives.
struct RecordedDerivatives {
  BackwardBatch& batch;

  TUREEN_ALWAYS_INLINE void bias(int biases, int o, const Pack& dy) const {
    Pack* layer = biases == kernels::biases1   ? batch.dy1
                  : biases == kernels::biases2 ? batch.dy2
                                               : batch.dy3;
    layer[o] = dy;
  }
  TUREEN_ALWAYS_INLINE void weight(int, int, const Pack&, const Pack&) const {}
};

/// Adds the derivatives by the parameters of one layer, for all batches at once: each sum is then
/// loaded and stored once.
template <int inputs, int outputs, int batches>
TUREEN_ALWAYS_INLINE void add_layer(Pack* weights, Pack* biases, const Pack* const (&x)[batches],
                                    const Pack* const (&dy)[batches]) {
  for (int o = 0; o < outputs; ++o) {
    Pack by_output[batches];
    for (int b = 0; b < batches; ++b) by_output[b] = dy[b][o];
    for (int b = 0; b < batches; ++b) biases[o] += by_output[b];
    for (int i = 0; i < inputs; ++i) {
      Pack sum = weights[o * inputs + i];
      for (int b = 0; b < batches; ++b) sum += x[b][i] * by_output[b];
      weights[o * inputs + i] = sum;
    }
  }
}

/// Adds the derivatives of these batches by all parameters.
template <int batches>
TUREEN_ALWAYS_INLINE void add_parameters(const BackwardBatch* batch, Pack* sums) {
  const Pack *x[batches], *dy[batches];
  const auto layer = [&](auto&& x_of, auto&& dy_of) __attribute__((always_inline)) {
    for (int b = 0; b < batches; ++b) {
      x[b] = x_of(batch[b]);
      dy[b] = dy_of(batch[b]);
    }
  };
  layer([](const BackwardBatch& b) { return b.state.input; },
        [](const BackwardBatch& b) { return b.dy1; });
  add_layer<mlp_inputs, mlp_width, batches>(sums + kernels::weights1, sums + kernels::biases1, x,
                                            dy);
  layer([](const BackwardBatch& b) { return b.state.hidden1; },
        [](const BackwardBatch& b) { return b.dy2; });
  add_layer<mlp_width, mlp_width, batches>(sums + kernels::weights2, sums + kernels::biases2, x,
                                           dy);
  layer([](const BackwardBatch& b) { return b.state.hidden2; },
        [](const BackwardBatch& b) { return b.dy3; });
  add_layer<mlp_width, mlp_outputs, batches>(sums + kernels::weights3, sums + kernels::biases3, x,
                                             dy);
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
  // Footprints are found a few batches ahead. A batch takes longer than a load from memory.
  constexpr int ahead = 4;
  Batch batches[ahead];
  Footprints footprints[ahead];
  BatchReader reader(image, y0, y1);
  bool more = true;
  for (int read = 0, shaded = 0;; ++shaded) {
    for (; more && read < shaded + ahead; ++read) {
      more = reader.next(batches[read % ahead]);
      if (!more) break;
      find_footprints(image, input, batches[read % ahead], footprints[read % ahead]);
    }
    if (shaded == read) break;
    const Batch& batch = batches[shaded % ahead];
    const Footprints& at = footprints[shaded % ahead];
    State state;
    gather(
        image.view, batch,
        [&](int l) __attribute__((always_inline)) {
          const std::array<float, 3> weights = {at.weights[0][l], at.weights[1][l]};
          const TexelPack features = lattice::interpolated(
              weights, kernels::load_texel(at.texels[0][l]), kernels::load_texel(at.texels[1][l]),
              kernels::load_texel(at.texels[2][l]));
          if (stores_features)
            kernels::store_texel(image.features[batch.pixel[l]].values, features);
          return features;
        },
        state);
    Pack color[3];
    kernels::shade(input.mlp->data(), state, color);
    for (int c = 0; c < 3; ++c)
      for (int l = 0; l < batch.count; ++l) image.color[c * pixels + batch.pixel[l]] = color[c][l];
  }
}

TUREEN_VECTOR_CLONES TUREEN_FLATTEN void shade_rows_backward(BatchImage& image,
                                                             const ShadingInput& input, int y0,
                                                             int y1, MlpParameters& mlp_gradient) {
  const std::size_t pixels = image.pixels();
  Pack sums[mlp_parameters] = {};
  BatchReader reader(image, y0, y1);
  Batch batch;
  constexpr int group = 4;  // batches whose derivatives stay in the first-level cache
  BackwardBatch backward[group];
  int waiting = 0;
  while (reader.next(batch)) {
    State& state = backward[waiting].state;
    gather(
        image.view, batch,
        [&](int l) __attribute__((always_inline)) {
          return kernels::load_texel(image.features[batch.pixel[l]].values);
        },
        state);
    const Pack zero = quarantine(state);
    Pack color[3], dcolor[3];
    kernels::shade(input.mlp->data(), state, color);
    for (int c = 0; c < 3; ++c) {
      alignas(64) float by_color[lanes] = {};
      for (int l = 0; l < batch.count; ++l)
        by_color[l] = image.by_color[c * pixels + batch.pixel[l]];
      dcolor[c] = zero < 1.0f ? load(by_color) : Pack{};
    }
    Pack dfeatures[kernels::features];
    kernels::network_backward(input.mlp->data(), state, dcolor,
                              RecordedDerivatives{backward[waiting]}, dfeatures);
    store_gradient(image, batch, dfeatures, input.half_scale);
    if (++waiting == group) {
      add_parameters<group>(backward, sums);
      waiting = 0;
    }
  }
  for (int i = 0; i < waiting; ++i) add_parameters<1>(backward + i, sums);
  for (int i = 0; i < mlp_parameters; ++i) {
    float sum = 0;
    for (int l = 0; l < lanes; ++l) sum += sums[i][l];
    mlp_gradient[std::size_t(i)] = sum;
  }
}

}  // namespace tureen::trainer
