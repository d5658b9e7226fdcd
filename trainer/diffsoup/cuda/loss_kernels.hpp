// The image loss, L1 and SSIM, and its gradient (trainer/common/kernels/image_loss.hpp), in tiles.
//
// The upper left pixel identifies an SSIM window. The first kernel compares the windows of a tile.
// The second kernel sums, for each pixel of a tile, the windows that contain it. It then has the
// pixel's whole loss, and computes the factor of the opacity's score from it.
#pragma once

#include <cmath>

#include "trainer/common/kernels/image_loss.hpp"
#include "trainer/diffsoup/cuda/device_image.hpp"

namespace tureen::trainer::cuda {

inline constexpr int ssim_reach = ssim_window - 1;

/// The position of a tile.
struct Tile {
  const DeviceImage* image;
  unsigned index;  // of the image
  int x0, y0;
};

TUREEN_HOST_DEVICE Tile tile_of(const DeviceBatch& batch, unsigned block) {
  unsigned i = 0;
  while (i + 1 < batch.count && batch.images[i + 1].first_tile <= block) ++i;
  const DeviceImage& image = batch.images[i];
  const unsigned within = block - image.first_tile;
  return {&image, i, int(within % image.tiles_x) * tile_width,
          int(within / image.tiles_x) * tile_height};
}

/// Whether a pixel's loss counts. A pixel with a channel that is not finite is ignored too.
enum class Counted { yes, ignored, not_finite };

TUREEN_HOST_DEVICE Counted counted(const DeviceImage& image, const float* color,
                                   std::size_t pixel) {
  const float* rendered = color + 3 * image.first_pixel + pixel;
  const std::size_t pixels = image.pixels();
  for (std::size_t c = 0; c < 3; ++c)
    if (!std::isfinite(rendered[c * pixels])) return Counted::not_finite;
  return image.ignored && image.ignored[pixel] ? Counted::ignored : Counted::yes;
}

/// The arguments of the moments. An ignored pixel has the photograph's colour.
TUREEN_HOST_DEVICE SsimPixel<float> pixel_of(const DeviceImage& image, const float* color,
                                             std::size_t pixel, std::size_t channel) {
  const std::size_t at = channel * image.pixels() + pixel;
  const float target = float(image.target[at]) / 255.0f;
  const bool counts = counted(image, color, pixel) == Counted::yes;
  return ssim_pixel(counts ? color[3 * image.first_pixel + at] : target, target);
}

/// The eleven weights applied to in[0], in[stride] .. in[10 stride].
TUREEN_HOST_DEVICE float weighed(const float* in, int stride) {
  float sum = float(ssim_weight(0)) * in[5 * stride];
  for (int offset = 1; offset <= 5; ++offset)
    sum += float(ssim_weight(offset)) * (in[(5 - offset) * stride] + in[(5 + offset) * stride]);
  return sum;
}

/// A tile of `planes` images with the margin of its windows, filtered in two passes: all threads of
/// a block filter the rows along x; at() filters a column.
template <int planes>
struct WeighedTile {
  static constexpr int wide = tile_width + ssim_reach, high = tile_height + ssim_reach;
  float in[planes][high][wide];
  float rows[planes][high][tile_width];

  TUREEN_HOST_DEVICE void weigh_rows(unsigned thread, unsigned threads) {
    for (int i = int(thread); i < tile_width * high; i += int(threads)) {
      const int x = i % tile_width, y = i / tile_width;
      for (int p = 0; p < planes; ++p) rows[p][y][x] = weighed(&in[p][y][x], 1);
    }
  }

  TUREEN_HOST_DEVICE float at(int plane, int x, int y) const {
    return weighed(&rows[plane][y][x], tile_width);
  }
};

/// Compares all windows. Writes three planes of derivatives per channel with the image's size; the
/// last ten rows and columns are not written. One block per tile.
struct CompareWindows {
  static constexpr unsigned threads = 256;
  using Tiles = WeighedTile<4>;  // sum, difference and their squares
  struct Shared {
    Tiles tile;
    double dissimilarity[threads];
  };
  struct Local {
    double dissimilarity;
  };
  DeviceBatch batch;
  const float* color;  // layout of Shade::color
  float* windows;      // [image][channel][3][y][x]
  ImageSums* sums;

  TUREEN_HOST_DEVICE unsigned phases() const { return 3 * 3 + 2; }

  template <class Atomics>
  TUREEN_HOST_DEVICE void run(unsigned phase, const Thread& at, Shared& shared,
                              Local& local) const {
    const Tile tile = tile_of(batch, at.block);
    if (phase < 9) {
      if (phase % 3 == 0) read(tile, phase / 3, at, shared);
      if (phase % 3 == 1) shared.tile.weigh_rows(at.thread, threads);
      if (phase % 3 == 2) compare(tile, phase / 3, at, shared, local);
    } else if (phase == 9) {
      shared.dissimilarity[at.thread] = local.dissimilarity;
    } else if (at.thread == 0) {
      double sum = 0;
      for (const double own : shared.dissimilarity) sum += own;
      Atomics::add(sums[tile.index].dissimilarity, to_fixed(sum, loss_scale));
    }
  }

  TUREEN_HOST_DEVICE void read(const Tile& tile, unsigned channel, const Thread& at,
                               Shared& shared) const {
    const int width = tile.image->view.width, height = tile.image->view.height;
    for (int i = int(at.thread); i < Tiles::wide * Tiles::high; i += int(threads)) {
      const int x = i % Tiles::wide, y = i / Tiles::wide;
      SsimPixel<float> pixel{0, 0};
      if (tile.x0 + x < width && tile.y0 + y < height)
        pixel = pixel_of(*tile.image, color,
                         std::size_t(tile.y0 + y) * std::size_t(width) + std::size_t(tile.x0 + x),
                         channel);
      shared.tile.in[0][y][x] = pixel.sum;
      shared.tile.in[1][y][x] = pixel.difference;
      shared.tile.in[2][y][x] = pixel.sum * pixel.sum;
      shared.tile.in[3][y][x] = pixel.difference * pixel.difference;
    }
  }

  TUREEN_HOST_DEVICE void compare(const Tile& tile, unsigned channel, const Thread& at,
                                  const Shared& shared, Local& local) const {
    const DeviceImage& image = *tile.image;
    const std::size_t pixels = image.pixels(), width = std::size_t(image.view.width);
    float* out = windows + 9 * image.first_pixel + 3 * channel * pixels;
    for (int i = int(at.thread); i < tile_width * tile_height; i += int(threads)) {
      const int x = i % tile_width, y = i / tile_width;
      if (tile.x0 + x + ssim_reach >= image.view.width ||
          tile.y0 + y + ssim_reach >= image.view.height)
        continue;
      SsimMoments<float> mean;
      mean.sum = shared.tile.at(0, x, y);
      mean.difference = shared.tile.at(1, x, y);
      mean.sum_squared = shared.tile.at(2, x, y);
      mean.difference_squared = shared.tile.at(3, x, y);
      const SsimDissimilarity<float> here = ssim_dissimilarity(mean);
      const std::size_t pixel = std::size_t(tile.y0 + y) * width + std::size_t(tile.x0 + x);
      out[pixel] = here.by_sum_variance;
      out[pixels + pixel] = here.by_difference_variance;
      out[2 * pixels + pixel] = here.constant;
      local.dissimilarity += double(here.value);
    }
  }
};

/// The weights in the loss of a step.
struct LossWeights {
  float l1, ssim;  // weights for one image: the configuration's, divided by the batch size
  float opacity;   // scale of the score's loss, before the division by 3 x pixels
  float baseline_rate;
};

/// Computes the gradient by all colours, the factor of the score, and the sums for the report. One
/// block per tile.
struct TakeLoss {
  static constexpr unsigned threads = 256;
  using Tiles = WeighedTile<3>;                                        // derivatives of the windows
  static constexpr int own = tile_width * tile_height / int(threads);  // pixels per thread
  struct Shared {
    Tiles tile;
    double l1[threads], squared[threads];
    unsigned shaded[threads], non_finite[threads];
  };
  struct Local {
    float loss[own];  // sum over channels of |C - G|
    double l1, squared;
  };
  DeviceBatch batch;
  LossWeights weights;
  const float* color;
  const float* windows;
  const VisibleKey* keys;
  float* by_color;   // layout of Shade::color
  float* advantage;  // one per pixel: factor of the score
  float* error;      // one per pixel: sum over channels of |C - G|
  ImageSums* sums;

  TUREEN_HOST_DEVICE unsigned phases() const { return 3 * 3 + 2; }

  template <class Atomics>
  TUREEN_HOST_DEVICE void run(unsigned phase, const Thread& at, Shared& shared,
                              Local& local) const {
    const Tile tile = tile_of(batch, at.block);
    if (phase < 9) {
      if (phase % 3 == 0) read(tile, phase / 3, at, shared);
      if (phase % 3 == 1) shared.tile.weigh_rows(at.thread, threads);
      if (phase % 3 == 2) write(tile, phase / 3, at, shared, local);
    } else if (phase == 9) {
      finish(tile, at, shared, local);
    } else if (at.thread == 0) {
      report<Atomics>(sums[tile.index], shared);
    }
  }

  /// Reads the windows with an upper left pixel in the tile, or up to ten pixels above or left of
  /// it.
  TUREEN_HOST_DEVICE void read(const Tile& tile, unsigned channel, const Thread& at,
                               Shared& shared) const {
    const DeviceImage& image = *tile.image;
    const std::size_t pixels = image.pixels(), width = std::size_t(image.view.width);
    const float* in = windows + 9 * image.first_pixel + 3 * channel * pixels;
    for (int i = int(at.thread); i < Tiles::wide * Tiles::high; i += int(threads)) {
      const int x = i % Tiles::wide, y = i / Tiles::wide;
      const int window_x = tile.x0 + x - ssim_reach, window_y = tile.y0 + y - ssim_reach;
      const bool there = window_x >= 0 && window_y >= 0 &&
                         window_x + ssim_reach < image.view.width &&
                         window_y + ssim_reach < image.view.height;
      for (std::size_t p = 0; p < 3; ++p)
        shared.tile.in[p][y][x] =
            there ? in[p * pixels + std::size_t(window_y) * width + std::size_t(window_x)] : 0;
    }
  }

  TUREEN_HOST_DEVICE void write(const Tile& tile, unsigned channel, const Thread& at,
                                const Shared& shared, Local& local) const {
    const DeviceImage& image = *tile.image;
    const std::size_t pixels = image.pixels(), width = std::size_t(image.view.width);
    const float columns = float(image.view.width - ssim_reach);
    const float rows = float(image.view.height - ssim_reach);
    // Images smaller than a window have no windows, and their planes are empty.
    const float ssim_scale =
        columns > 0 && rows > 0 ? weights.ssim / (6.0f * (columns * rows)) : 0.0f;
    const float l1_scale = weights.l1 / float(3 * pixels);
    for (int k = 0; k < own; ++k) {
      const int i = int(at.thread) + k * int(threads);
      const int x = i % tile_width, y = i / tile_width;
      if (tile.x0 + x >= image.view.width || tile.y0 + y >= image.view.height) continue;
      const std::size_t pixel = std::size_t(tile.y0 + y) * width + std::size_t(tile.x0 + x);
      const bool counts = counted(image, color, pixel) == Counted::yes;
      const SsimPixel<float> here = pixel_of(image, color, pixel, channel);
      float gradient = l1_scale * sign(here.difference);
      gradient += ssim_scale * ssim_derivative(here, shared.tile.at(0, x, y),
                                               shared.tile.at(1, x, y), shared.tile.at(2, x, y));
      by_color[3 * image.first_pixel + channel * pixels + pixel] = counts ? gradient : 0.0f;
      local.loss[k] += std::fabs(here.difference);
      local.l1 += double(std::fabs(here.difference));
      local.squared += double(here.difference) * double(here.difference);
    }
  }

  TUREEN_HOST_DEVICE void finish(const Tile& tile, const Thread& at, Shared& shared,
                                 Local& local) const {
    const DeviceImage& image = *tile.image;
    unsigned shaded = 0, non_finite = 0;
    for (int k = 0; k < own; ++k) {
      const int i = int(at.thread) + k * int(threads);
      const int x = tile.x0 + i % tile_width, y = tile.y0 + i / tile_width;
      if (x >= image.view.width || y >= image.view.height) continue;
      const std::size_t pixel = std::size_t(y) * std::size_t(image.view.width) + std::size_t(x);
      shaded += keys[image.first_pixel + pixel] != 0;
      const Counted counts = counted(image, color, pixel);
      non_finite += counts == Counted::not_finite;
      float loss = local.loss[k];
      error[image.first_pixel + pixel] = loss;
      // An ignored pixel has a loss of 0, which must not change the running mean.
      if (image.baseline && counts == Counted::yes) loss -= run_on(image.baseline[pixel], loss);
      advantage[image.first_pixel + pixel] =
          loss * (weights.opacity / (3.0f * float(image.pixels())));
    }
    shared.l1[at.thread] = local.l1;
    shared.squared[at.thread] = local.squared;
    shared.shaded[at.thread] = shaded;
    shared.non_finite[at.thread] = non_finite;
  }

  /// Returns the running mean of a pixel's loss and then updates it. `stored` is encoded as in
  /// TrainingState::baseline.
  TUREEN_HOST_DEVICE float run_on(std::uint16_t& stored, float loss) const {
    const float root = float(stored) / 65535;
    const float mean = 3 * root * root;
    const float next = stored ? mean + weights.baseline_rate * (loss - mean) : loss;
    const float code = 65535 * std::sqrt(next / 3) + 0.5f;
    stored = std::uint16_t(code < 1.0f ? 1.0f : code > 65535.0f ? 65535.0f : code);
    return mean;
  }

  template <class Atomics>
  TUREEN_HOST_DEVICE void report(ImageSums& out, const Shared& shared) const {
    double l1 = 0, squared = 0;
    unsigned long long shaded = 0, non_finite = 0;
    for (unsigned t = 0; t < threads; ++t) {
      l1 += shared.l1[t];
      squared += shared.squared[t];
      shaded += shared.shaded[t];
      non_finite += shared.non_finite[t];
    }
    Atomics::add(out.l1, to_fixed(l1, loss_scale));
    Atomics::add(out.squared, to_fixed(squared, loss_scale));
    Atomics::add(out.shaded, shaded);
    Atomics::add(out.non_finite, non_finite);
  }
};

}  // namespace tureen::trainer::cuda
