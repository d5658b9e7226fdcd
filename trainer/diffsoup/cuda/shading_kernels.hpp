// Colours of pixels, and the backward pass to features and network.
//
// The gradient of the network is a sum over all pixels of outer products. A block first stores the
// activations of its pixels and the derivatives by its layers' sums in shared memory. Then each
// thread sums a few weights over these pixels.
#pragma once

#include <cmath>

#include "trainer/diffsoup/cuda/visibility_kernels.hpp"
#include "trainer/diffsoup/kernels/color_network.hpp"

namespace tureen::trainer::cuda {

/// The network's input for a pixel: features from the texture of the visible face, and harmonics of
/// the direction to the eye.
TUREEN_HOST_DEVICE void network_input(const DeviceImage& image, const DeviceModel& model,
                                      const kernels::ProjectedFace& projected, std::uint32_t face,
                                      std::size_t pixel, float* input) {
  const kernels::View& view = image.view;
  const int x = int(pixel % std::size_t(view.width)), y = int(pixel / std::size_t(view.width));
  kernels::Fragment fragment{};
  kernels::fragment_at(view, projected, x, y, fragment);
  const auto at = lattice::footprint(model.max_level, fragment.b0, fragment.b1);
  const float* texture = model.values + face * model.fine_texels() * channels;
  for (int f = 0; f < kernels::features; ++f) {
    const auto value = [&](std::size_t j) {
      return texture[std::size_t(at.texels[j]) * channels + std::size_t(f)];
    };
    input[f] = lattice::interpolated(at.weights, value(0), value(1), value(2));
  }
  const float right = (float(x) + float(0.5 - view.cx)) * float(1 / view.fx);
  const float down = (float(y) + float(0.5 - view.cy)) * float(1 / view.fy);
  float direction[3];
  for (int i = 0; i < 3; ++i)
    direction[i] =
        -(right * float(view.right[i]) + down * float(view.down[i]) + float(view.forward[i]));
  const float scale = 1 / std::sqrt(direction[0] * direction[0] + direction[1] * direction[1] +
                                    direction[2] * direction[2]);
  kernels::harmonics9(direction[0] * scale, direction[1] * scale, direction[2] * scale,
                      input + kernels::features);
}

/// Fills `color`: three planes per image, image after image. One thread per pixel.
struct Shade {
  static constexpr unsigned threads = 128;
  struct Shared {
    alignas(16) float mlp[mlp_parameters];
  };
  using Local = Nothing;
  DeviceBatch batch;
  DeviceModel model;
  const kernels::ProjectedFace* projected;
  const VisibleKey* keys;
  float* color;

  TUREEN_HOST_DEVICE unsigned phases() const { return 2; }
  template <class Atomics>
  TUREEN_HOST_DEVICE void run(unsigned phase, const Thread& at, Shared& shared, Local&) const {
    if (phase == 0) {
      for (unsigned i = at.thread; i < mlp_parameters; i += threads) shared.mlp[i] = model.mlp[i];
      return;
    }
    const std::size_t i = std::size_t(at.block) * threads + at.thread;
    if (i >= batch.pixels) return;
    const DeviceImage& image = batch.image_of(i);
    const std::size_t pixel = i - image.first_pixel, pixels = image.pixels();
    float result[3] = {model.background[0], model.background[1], model.background[2]};
    if (keys[i] != 0) {
      const std::uint32_t face = face_of(keys[i]);
      kernels::NetworkState<float> state;
      network_input(image, model,
                    projected[std::size_t(&image - batch.images) * model.faces + face], face, pixel,
                    state.input);
      kernels::shade(shared.mlp, state, result);
    }
    for (std::size_t c = 0; c < 3; ++c)
      color[3 * image.first_pixel + c * pixels + pixel] = result[c];
  }
};

/// A pixel's share in the network's gradient: each layer's inputs, and the derivatives by its sums.
struct NetworkShare {
  float input[mlp_inputs], hidden1[mlp_width], hidden2[mlp_width];
  float dz1[mlp_width], dz2[mlp_width], dz3[mlp_outputs];
};

/// Stores the derivatives by a layer's sums (for kernels::network_backward). ShadeBackward::add_up
/// computes the products later.
struct KeptDerivatives {
  NetworkShare* share;

  TUREEN_HOST_DEVICE float* of(int biases) const {
    if (biases == kernels::biases1) return share->dz1;
    return biases == kernels::biases2 ? share->dz2 : share->dz3;
  }
  TUREEN_HOST_DEVICE void bias(int biases, int o, const float& dy) const {
    of(biases)[o] = dy;
#if defined(__CUDA_ARCH__)
    // Without this barrier nvcc loads the weights of many outputs ahead, and has too few registers.
    asm volatile("" ::: "memory");
#endif
  }
  TUREEN_HOST_DEVICE void weight(int, int, const float&, const float&) const {}
};

/// Computes dL/dfeatures for each pixel, and the sum of the network's gradient for each block. Any
/// number of blocks; block b takes the runs b, b + blocks, .. of `threads` pixels.
struct ShadeBackward {
  static constexpr unsigned threads = 128;
  struct Shared {
    alignas(16) float mlp[mlp_parameters];
    bool shows[threads];           // whether the pixel shows a face; if not, its share is undefined
    NetworkShare shares[threads];  // 83 floats each: an odd number, so threads use different banks
  };
  struct Local {
    float weights1[2], weights2[2], weights3, biases;
  };
  DeviceBatch batch;
  DeviceModel model;
  const kernels::ProjectedFace* projected;
  const VisibleKey* keys;
  const float* by_color;  // layout of Shade::color
  unsigned blocks;        // number of launched blocks
  float* by_features;     // [pixel][channels]; the last channel is 0
  float half_scale;       // if not 0: scale of feature gradients for rounding to half precision
  float* by_mlp;          // [block][mlp_parameters]

  TUREEN_HOST_DEVICE std::size_t rounds() const {
    const std::size_t a_round = std::size_t(blocks) * threads;
    return (batch.pixels + a_round - 1) / a_round;
  }

  /// Phase 0 loads the network. Each round then has two phases: every thread computes its pixel,
  /// and every thread sums its weights. The last phase writes the sums.
  TUREEN_HOST_DEVICE unsigned phases() const { return unsigned(2 * rounds()) + 2; }

  template <class Atomics>
  TUREEN_HOST_DEVICE void run(unsigned phase, const Thread& at, Shared& shared,
                              Local& local) const {
    if (phase == 0) {
      for (unsigned i = at.thread; i < mlp_parameters; i += threads) shared.mlp[i] = model.mlp[i];
      return;
    }
    if (phase + 1 == phases()) {
      write(at, local);
      return;
    }
    const std::size_t first = (std::size_t((phase - 1) / 2) * blocks + at.block) * threads;
    if (phase % 2 == 1)
      take_pixel(first, at, shared);
    else
      add_up(at, shared, local);
  }

  TUREEN_HOST_DEVICE void take_pixel(std::size_t first, const Thread& at, Shared& shared) const {
    const std::size_t i = first + at.thread;
    shared.shows[at.thread] = i < batch.pixels && keys[i] != 0;
    if (!shared.shows[at.thread]) return;
    const DeviceImage& image = batch.image_of(i);
    const std::size_t pixel = i - image.first_pixel, pixels = image.pixels();
    const std::uint32_t face = face_of(keys[i]);
    kernels::NetworkState<float> state;
    network_input(image, model, projected[std::size_t(&image - batch.images) * model.faces + face],
                  face, pixel, state.input);
    // NaN and infinity would reach the network's gradient even times zero.
    bool finite = true;
    for (int f = 0; f < kernels::features; ++f) finite = finite && std::isfinite(state.input[f]);
    for (int f = 0; f < kernels::features; ++f) state.input[f] = finite ? state.input[f] : 0.0f;
    float color[3], dcolor[3], dfeatures[kernels::features];
    kernels::shade(shared.mlp, state, color);
    for (std::size_t c = 0; c < 3; ++c)
      dcolor[c] = finite ? by_color[3 * image.first_pixel + c * pixels + pixel] : 0.0f;
    NetworkShare& share = shared.shares[at.thread];
    kernels::network_backward(shared.mlp, state, dcolor, KeptDerivatives{&share}, dfeatures);
    for (int k = 0; k < mlp_width; ++k) {
      share.input[k] = state.input[k];
      share.hidden1[k] = state.hidden1[k];
      share.hidden2[k] = state.hidden2[k];
    }
    float* out = by_features + i * channels;
    for (int f = 0; f < kernels::features; ++f)
      out[f] = half_scale == 0 ? dfeatures[f]
                               : kernels::rounded_to_half(dfeatures[f] * half_scale) / half_scale;
    out[alpha_channel] = 0;
  }

  /// Thread t sums the weights from input t % 16 to outputs t / 16 and t / 16 + 8 of both hidden
  /// layers. The first 48 threads also sum the last layer's weights; 35 other threads sum a bias.
  TUREEN_HOST_DEVICE void add_up(const Thread& at, const Shared& shared, Local& local) const {
    static_assert(threads == mlp_width * mlp_width / 2 && mlp_inputs == mlp_width);
    const unsigned t = at.thread, i = t % mlp_width, o = t / mlp_width;
    for (unsigned p = 0; p < threads; ++p) {
      if (!shared.shows[p]) continue;
      const NetworkShare& share = shared.shares[p];
      for (unsigned half = 0; half < 2; ++half) {
        local.weights1[half] += share.input[i] * share.dz1[o + half * 8];
        local.weights2[half] += share.hidden1[i] * share.dz2[o + half * 8];
      }
      if (t < mlp_outputs * mlp_width) local.weights3 += share.hidden2[i] * share.dz3[o];
      // The biases have the order of dz1, dz2, dz3.
      if (bias_of(t) >= 0) local.biases += derivative(share, bias_of(t));
    }
  }

  static constexpr int all_biases = 2 * mlp_width + mlp_outputs;

  /// The bias that thread t sums; negative if it has none. Threads from 64 on have no weight of the
  /// last layer.
  TUREEN_HOST_DEVICE static int bias_of(unsigned t) {
    const int bias = int(t) - 64;
    return bias < all_biases ? bias : -1;
  }
  TUREEN_HOST_DEVICE static float derivative(const NetworkShare& share, int bias) {
    if (bias < mlp_width) return share.dz1[bias];
    return bias < 2 * mlp_width ? share.dz2[bias - mlp_width] : share.dz3[bias - 2 * mlp_width];
  }
  TUREEN_HOST_DEVICE static int parameter_of_bias(int bias) {
    if (bias < mlp_width) return kernels::biases1 + bias;
    return bias < 2 * mlp_width ? kernels::biases2 + bias - mlp_width
                                : kernels::biases3 + bias - 2 * mlp_width;
  }

  TUREEN_HOST_DEVICE void write(const Thread& at, const Local& local) const {
    const int t = int(at.thread), i = t % mlp_width, o = t / mlp_width;
    const auto put = [&](int parameter, float sum) {
      by_mlp[std::size_t(at.block) * mlp_parameters + std::size_t(parameter)] = sum;
    };
    for (int half = 0; half < 2; ++half) {
      put(kernels::weights1 + (o + half * 8) * mlp_inputs + i, local.weights1[half]);
      put(kernels::weights2 + (o + half * 8) * mlp_width + i, local.weights2[half]);
    }
    if (t < mlp_outputs * mlp_width) put(kernels::weights3 + o * mlp_width + i, local.weights3);
    if (bias_of(at.thread) >= 0) put(parameter_of_bias(bias_of(at.thread)), local.biases);
  }
};

}  // namespace tureen::trainer::cuda
