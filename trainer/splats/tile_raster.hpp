// One view of splats in training: forward to an image, backward to the moments of each splat, for
// any kernel. Threads share rows of tiles; the result has the same bits with any number of threads,
// since each pair of a splat and a tile has a place of its own, and a splat adds its pairs in their
// order.
#pragma once

#include <hwy/cache_control.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "base/threads/thread_pool.hpp"
#include "scene/camera.hpp"
#include "splatting/depth_order.hpp"
#include "splatting/image_view.hpp"
#include "splatting/parameter_rows.hpp"
#include "splatting/tiles/tile_lists.hpp"
#include "trainer/common/stopwatch.hpp"
#include "trainer/splats/projected_splats.hpp"
#include "trainer/splats/splat_step.hpp"
#include "trainer/splats/tile_passes.hpp"

namespace tureen::trainer {

/// Seconds of each stage, sums over steps, and the amount of work.
struct SplatTimes {
  double projection = 0, lists = 0, forward = 0, loss = 0, backward = 0, update = 0;
  std::uint64_t steps = 0, pairs = 0;

  double total() const { return projection + lists + forward + loss + backward + update; }
};

/// Calls act(index in TilePixels, index in the image, pixels) for the runs of pixels of a tile that
/// are in the image: at most a block's row each.
template <class Act>
void for_each_run(int x, int y, int width, int height, const Act& act) {
  using splatting::block_pixels, splatting::block_side;
  constexpr int blocks_a_side = splatting::tile_side / block_side;
  for (int block = 0; block < splatting::blocks_a_tile; ++block)
    for (int row = 0; row < block_side; ++row) {
      const int left = x + block_side * (block % blocks_a_side);
      const int top = y + block_side * (block / blocks_a_side) + row;
      const int pixels = std::min(block_side, width - left);
      if (top >= height || pixels <= 0) continue;
      act(std::size_t(block) * block_pixels + std::size_t(row) * block_side,
          std::size_t(top) * std::size_t(width) + std::size_t(left), std::size_t(pixels));
    }
}

/// A loss of the variance of the colour within pixels: `weight` times the mean over pixels and
/// channels of V = sum_i w_i c_i^2 - C^2, with the weights w_i of the splats and of the background.
/// If they are the parts of the pixel that each covers, one random sample of the pixel has the
/// expected squared error V + (C - G)^2 against the photograph G.
struct VarianceLoss {
  float weight = 0;
  std::span<const std::uint8_t> ignored = {};  // as in ImageLossView
};

/// `Training`: as GaussianTraining. The types Kernel, Parameters and
/// Moments, `profile`, tile_functions() and perhaps has_variance are used.
template <class Training>
class TileRaster {
 public:
  using Parameters = typename Training::Parameters;
  using Moments = typename Training::Moments;
  static constexpr std::string_view profile = Training::profile;
  /// Whether the passes of the method sum what a VarianceLoss needs.
  static constexpr bool has_variance = requires { requires Training::has_variance; };

  explicit TileRaster(ThreadPool& pool) : pool_(pool) {}

  /// Draws the splats by the method's profile, with harmonics up to `degree`, over an opaque
  /// background, 0..1. `planes`: red, green and blue, row 0 on top, not clamped. `keeps_squares`:
  /// keeps the sums that a VarianceLoss in backward() needs; only with has_variance.
  void forward(const Parameters& parameters, const Camera& camera, int degree,
               std::span<const float, 3> background, std::span<float> planes,
               bool keeps_squares = false) {
    assert(planes.size() == 3 * std::size_t(camera.width) * std::size_t(camera.height));
    assert(has_variance || !keeps_squares);
    view_ =
        splatting::image_view(camera, camera.eye(), near_plane, *profile_named(profile), camera);
    if constexpr (requires { parameters.solidity; }) view_.solidity = parameters.solidity;
    keeps_squares_ = keeps_squares;
    std::copy(background.begin(), background.end(), background_);
    degree_ = std::min(degree, parameters.degree);
    project(parameters);
    make_lists(parameters.count());
    const Stopwatch watch(times_.forward);
    rows_.resize(std::size_t(lists_.rows()));
    pool_.run(rows_.size(), [&](std::size_t row) { draw_row(int(row), planes); });
  }

  /// After forward() of the same camera and parameters. `planes` are its result, `gradient` the
  /// derivatives of a loss by them. Valid until the next call.
  BackwardInput<Moments> backward(std::span<const float> planes, std::span<const float> gradient,
                                  const VarianceLoss& variance = {}) {
    assert(variance.weight == 0 || keeps_squares_);
    const Stopwatch watch(times_.backward);
    moments_.resize(lists_.pairs());
    pool_.run(rows_.size(),
              [&](std::size_t row) { draw_row_backward(int(row), planes, gradient, variance); });
    times_.pairs += lists_.pairs();
    return {view_, degree_, pairs_, moments_};
  }

  SplatTimes& times() { return times_; }
  /// Pairs of a splat and a tile in the last view.
  std::size_t pairs() const { return lists_.pairs(); }

 private:
  /// In layer units. Below min_center_depth of the profiles, so it removes no whole splat.
  static constexpr double near_plane = 1e-3;

  /// The results of the forward pass of a row of tiles, for the backward pass.
  struct Row {
    std::vector<std::uint32_t> blended;
    std::vector<TileRecord> records;
    TileScratch scratch;
  };

  void project(const Parameters& parameters) {
    const Stopwatch watch(times_.projection);
    projected_.project(pool_, view_, parameters.drawn, degree_);
  }

  void make_lists(std::size_t count) {
    const Stopwatch watch(times_.lists);
    order_.begin();
    order_.add_layer(count, [&](std::uint32_t i) { return projected_.depth(i); });
    order_.sort();
    const std::span<const KeyedIndex> order = order_.entries();
    lists_.begin(view_.width, view_.height);
    pairs_.assign(count, {0, 0});
    for (std::size_t place = 0; place < order.size(); ++place) {
      // Neighbours in the order are far apart in memory.
      if (place + 8 < order.size())
        hwy::Prefetch(static_cast<const char*>(projected_.listed(order[place + 8].index)));
      const std::uint32_t splat = order[place].index;
      const std::uint32_t begin = lists_.pairs();
      projected_.list(splat, lists_);
      pairs_[splat] = {begin, lists_.pairs()};
    }
    // Renumbers the pairs in the order of the splats in memory, in which their moments are read.
    shifts_.resize(count);
    std::uint32_t pairs = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const auto [begin, end] = pairs_[i];
      shifts_[i] = pairs - begin;
      pairs_[i] = {pairs, pairs + (end - begin)};
      pairs += end - begin;
    }
  }

  /// Reads the entries of a tile into the cache while the tile before it is drawn. Otherwise each
  /// would be a cache miss.
  void prefetch(int column, int row) const {
    if (column >= lists_.columns()) return;
    for (const std::uint32_t splat : lists_.tile(column, row))
      prefetch_object(projected_.entries()[splat]);
  }
  /// All cache lines of it, which have 64 bytes or more.
  template <class Object>
  static void prefetch_object(const Object& object) {
    for (std::size_t at = 0; at < sizeof object; at += 64)
      hwy::Prefetch(reinterpret_cast<const char*>(&object) + at);
  }

  void draw_row(int row, std::span<float> planes) {
    using splatting::tile_side, splatting::tile_pixels, splatting::blocks_a_tile;
    lists_.finish_with_numbers(row, shifts_);
    Row& kept = rows_[std::size_t(row)];
    kept.records.resize(std::size_t(lists_.columns()));
    std::size_t listed = 0;
    for (int column = 0; column < lists_.columns(); ++column)
      listed += lists_.tile(column, row).size();
    kept.blended.resize(listed * blocks_a_tile);
    std::uint32_t* blended = kept.blended.data();
    const std::size_t pixels_a_plane = planes.size() / 3;
    const float background_square = background_[0] * background_[0] +
                                    background_[1] * background_[1] +
                                    background_[2] * background_[2];
    prefetch(0, row);
    for (int column = 0; column < lists_.columns(); ++column) {
      prefetch(column + 1, row);
      splatting::TilePixels pixels{};
      pixels.x = column * tile_side;
      pixels.y = row * tile_side;
      // Pixels outside the image are closed.
      std::fill_n(pixels.transmittance, tile_pixels, -1.0f);
      for_each_run(pixels.x, pixels.y, view_.width, view_.height,
                   [&](std::size_t at, std::size_t, std::size_t count) {
                     std::fill_n(pixels.transmittance + at, count, 1.0f);
                   });
      TileRecord& record = kept.records[std::size_t(column)];
      record.blended = blended;
      record.keeps_squares = keeps_squares_;
      Training::tile_functions().blend_recorded(view_, projected_.entries(),
                                                lists_.tile(column, row), pixels, record);
      blended += record.ends[blocks_a_tile - 1];
      for_each_run(pixels.x, pixels.y, view_.width, view_.height,
                   [&](std::size_t at, std::size_t pixel, std::size_t count) {
                     for (std::size_t i = 0; i < count; ++i) {
                       const float left = std::abs(pixels.transmittance[at + i]);
                       if (keeps_squares_) record.squares[at + i] += left * background_square;
                       float* out = planes.data() + pixel + i;
                       out[0] = pixels.red[at + i] + left * background_[0];
                       out[pixels_a_plane] = pixels.green[at + i] + left * background_[1];
                       out[2 * pixels_a_plane] = pixels.blue[at + i] + left * background_[2];
                     }
                   });
    }
  }

  void draw_row_backward(int row, std::span<const float> planes, std::span<const float> gradient,
                         const VarianceLoss& variance) {
    using splatting::tile_side, splatting::tile_pixels;
    Row& kept = rows_[std::size_t(row)];
    const std::size_t pixels_a_plane = planes.size() / 3;
    // L = .. + by_square (Q - C . C), with Q in trainer/splats/tile_passes.hpp.
    const float by_square = variance.weight / float(planes.size());
    prefetch(0, row);
    for (int column = 0; column < lists_.columns(); ++column) {
      prefetch(column + 1, row);
      if (lists_.tile(column, row).empty()) continue;
      const TileRecord& record = kept.records[std::size_t(column)];
      TileGradient tile{};
      tile.by_square = by_square;
      tile.x = column * tile_side;
      tile.y = row * tile_side;
      std::fill_n(tile.transmittance, tile_pixels, -1.0f);
      for_each_run(tile.x, tile.y, view_.width, view_.height,
                   [&](std::size_t at, std::size_t pixel, std::size_t count) {
                     for (std::size_t i = 0; i < count; ++i) {
                       // The gradient is 0 there, and the variance does not count.
                       if (!variance.ignored.empty() && variance.ignored[pixel + i]) continue;
                       const float* value = planes.data() + pixel + i;
                       const float* by_value = gradient.data() + pixel + i;
                       const auto by = [&](std::size_t plane) {
                         return by_value[plane] - 2 * by_square * value[plane];
                       };
                       const std::size_t green = pixels_a_plane, blue = 2 * green;
                       tile.red[at + i] = by(0);
                       tile.green[at + i] = by(green);
                       tile.blue[at + i] = by(blue);
                       tile.behind[at + i] =
                           by(0) * value[0] + by(green) * value[green] + by(blue) * value[blue];
                       if (by_square > 0) tile.behind[at + i] += by_square * record.squares[at + i];
                       tile.transmittance[at + i] = 1;
                     }
                   });
      Training::tile_functions().blend_backward(
          view_, projected_.entries(), lists_.tile(column, row), lists_.pair_numbers(column, row),
          record, tile, kept.scratch, moments_);
    }
  }

  ThreadPool& pool_;
  splatting::ImageView view_{};
  int degree_ = 0;
  ProjectedSplats<typename Training::Kernel> projected_;  // in their order in memory
  splatting::DepthOrder order_;
  std::vector<PairSpan> pairs_;        // of each splat
  std::vector<std::uint32_t> shifts_;  // of the numbers of each splat's pairs
  splatting::TileLists lists_;
  std::vector<Row> rows_;
  bool keeps_squares_ = false;
  float background_[3] = {};
  std::vector<Moments> moments_;  // of the pairs
  SplatTimes times_;
};

}  // namespace tureen::trainer
