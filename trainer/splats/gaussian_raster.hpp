// One view of Gaussians in training: forward to an image, backward to the parameters. Threads share
// rows of tiles and blocks of splats; the result has the same bits with any number of threads,
// since each pair of a splat and a tile has a place of its own, and a splat adds its pairs in their
// order.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/radix_sort.hpp"
#include "scene/camera.hpp"
#include "splatting/gaussian_entries.hpp"
#include "splatting/tile_lists.hpp"
#include "trainer/common/cpu/thread_pool.hpp"
#include "trainer/splats/gaussian_step_kernels.hpp"

namespace tureen::trainer {

/// Seconds of each stage, sums over steps, and the amount of work.
struct SplatTimes {
  double projection = 0, lists = 0, forward = 0, loss = 0, backward = 0, update = 0;
  std::uint64_t steps = 0, pairs = 0;

  double total() const { return projection + lists + forward + loss + backward + update; }
};

/// Threads share splats in groups of this many, a multiple of splatting::row_alignment.
inline constexpr std::size_t splats_a_task = 1024;

class GaussianRaster {
 public:
  explicit GaussianRaster(ThreadPool& pool) : pool_(pool) {}

  /// Draws the Gaussians by the profile "3dgs", with harmonics up to `degree`, over an opaque
  /// background. `planes`: red, green and blue, row 0 on top, not clamped.
  void forward(const GaussianParameters& parameters, const Camera& camera, int degree,
               std::span<const float, 3> background, std::span<float> planes);

  /// After forward() of the same camera and parameters. `planes` are its result, `gradient` the
  /// derivatives of a loss by them. Valid until the next call.
  GaussianBackwardInput backward(std::span<const float> planes, std::span<const float> gradient);

  SplatTimes& times() { return times_; }
  /// Pairs of a splat and a tile in the last view.
  std::size_t pairs() const { return lists_.pairs(); }

 private:
  /// The results of the forward pass of a row of tiles, for the backward pass.
  struct Row {
    std::vector<std::uint32_t> blended;
    std::vector<TileRecord> records;
    MomentScratch scratch;
  };
  void project(const GaussianParameters& parameters);
  void make_lists();
  void prefetch(int column, int row) const;
  void draw_row(int row, std::span<const float, 3> background, std::span<float> planes);
  void draw_row_backward(int row, std::span<const float> planes, std::span<const float> gradient);

  ThreadPool& pool_;
  splatting::ImageView view_{};
  int degree_ = 0;
  std::vector<splatting::GaussianEntry> entries_;
  std::vector<KeyedIndex> keys_, scratch_;
  std::vector<PairRange> ranges_;      // of each splat
  std::vector<std::uint32_t> shifts_;  // of the numbers of each splat's pairs
  splatting::TileLists lists_;
  std::vector<Row> rows_;
  std::vector<GaussianMoments> moments_;  // of the pairs
  SplatTimes times_;
};

}  // namespace tureen::trainer
