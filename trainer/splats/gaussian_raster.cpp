#include "trainer/splats/gaussian_raster.hpp"

#include <hwy/cache_control.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "trainer/common/stopwatch.hpp"

namespace tureen::trainer {

namespace {

using splatting::block_pixels;
using splatting::block_side;
using splatting::blocks_a_tile;
using splatting::tile_pixels;
using splatting::tile_side;

/// Centres nearer than this are not drawn: min_center_depth of the profile is larger.
constexpr double near_plane = 1e-3;

/// Calls act(index in TilePixels, index in the image, pixels) for the runs of pixels of a tile that
/// are in the image: at most a block's row each.
template <class Act>
void for_each_run(int x, int y, int width, int height, const Act& act) {
  constexpr int blocks_a_side = tile_side / block_side;
  for (int block = 0; block < blocks_a_tile; ++block)
    for (int row = 0; row < block_side; ++row) {
      const int left = x + block_side * (block % blocks_a_side);
      const int top = y + block_side * (block / blocks_a_side) + row;
      const int pixels = std::min(block_side, width - left);
      if (top >= height || pixels <= 0) continue;
      act(std::size_t(block * block_pixels + row * block_side),
          std::size_t(top) * std::size_t(width) + std::size_t(left), std::size_t(pixels));
    }
}

}  // namespace

void GaussianRaster::project(const GaussianParameters& parameters) {
  const Stopwatch watch(times_.projection);
  const std::size_t count = parameters.count();
  entries_.resize(count);
  pool_.run((count + splats_a_task - 1) / splats_a_task, [&](std::size_t task) {
    const std::size_t begin = task * splats_a_task;
    splatting::project_gaussians(
        view_, parameters.drawn, degree_, begin,
        std::span(entries_).subspan(begin, std::min(splats_a_task, count - begin)));
  });
}

void GaussianRaster::make_lists() {
  const Stopwatch watch(times_.lists);
  keys_.clear();
  for (std::uint32_t i = 0; i < entries_.size(); ++i)
    if (std::isfinite(entries_[i].depth)) keys_.push_back({sort_key(entries_[i].depth), i});
  radix_sort(keys_, scratch_);

  const float min_log_alpha = std::log2(view_.min_alpha);
  lists_.begin(view_.width, view_.height);
  ranges_.assign(entries_.size(), {0, 0});
  for (std::size_t place = 0; place < keys_.size(); ++place) {
    // Neighbours in the order are not so in memory.
    if (place + 8 < keys_.size()) hwy::Prefetch(&entries_[keys_[place + 8].index]);
    const std::uint32_t splat = keys_[place].index;
    const std::uint32_t begin = lists_.pairs();
    splatting::list_gaussian(entries_[splat], min_log_alpha, splat, lists_);
    ranges_[splat] = {begin, lists_.pairs()};
  }
  // Renumbers the pairs in the order of the splats in memory, in which their moments are read.
  shifts_.resize(entries_.size());
  std::uint32_t pairs = 0;
  for (std::size_t i = 0; i < ranges_.size(); ++i) {
    const auto [begin, end] = ranges_[i];
    shifts_[i] = pairs - begin;
    ranges_[i] = {pairs, pairs + (end - begin)};
    pairs += end - begin;
  }
}

/// Reads the entries of a tile into the cache, while the tile before it is drawn: each is a miss.
void GaussianRaster::prefetch(int column, int row) const {
  if (column >= lists_.columns()) return;
  for (const std::uint32_t splat : lists_.tile(column, row)) hwy::Prefetch(&entries_[splat]);
}

void GaussianRaster::draw_row(int row, std::span<const float, 3> background,
                              std::span<float> planes) {
  lists_.finish_with_numbers(row, shifts_);
  Row& kept = rows_[std::size_t(row)];
  kept.records.resize(std::size_t(lists_.columns()));
  std::size_t listed = 0;
  for (int column = 0; column < lists_.columns(); ++column)
    listed += lists_.tile(column, row).size();
  kept.blended.resize(listed * blocks_a_tile + 1);  // one place is written but not used
  std::uint32_t* blended = kept.blended.data();
  const std::size_t pixels_a_plane = planes.size() / 3;
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
    blend_gaussians_recorded(view_, entries_, lists_.tile(column, row), pixels, record);
    blended += record.ends[blocks_a_tile - 1];
    for_each_run(pixels.x, pixels.y, view_.width, view_.height,
                 [&](std::size_t at, std::size_t pixel, std::size_t count) {
                   for (std::size_t i = 0; i < count; ++i) {
                     const float left = std::abs(pixels.transmittance[at + i]);
                     float* out = planes.data() + pixel + i;
                     out[0] = pixels.red[at + i] + left * background[0];
                     out[pixels_a_plane] = pixels.green[at + i] + left * background[1];
                     out[2 * pixels_a_plane] = pixels.blue[at + i] + left * background[2];
                   }
                 });
  }
}

void GaussianRaster::forward(const GaussianParameters& parameters, const Camera& camera, int degree,
                             std::span<const float, 3> background, std::span<float> planes) {
  assert(planes.size() == 3 * std::size_t(camera.width) * std::size_t(camera.height));
  view_ = splatting::image_view(camera, camera.eye(), near_plane, *profile_named("3dgs"), camera);
  degree_ = std::min(degree, parameters.degree);
  project(parameters);
  make_lists();
  const Stopwatch watch(times_.forward);
  rows_.resize(std::size_t(lists_.rows()));
  pool_.run(rows_.size(), [&](std::size_t row) { draw_row(int(row), background, planes); });
}

void GaussianRaster::draw_row_backward(int row, std::span<const float> planes,
                                       std::span<const float> gradient) {
  Row& kept = rows_[std::size_t(row)];
  const std::size_t pixels_a_plane = planes.size() / 3;
  prefetch(0, row);
  for (int column = 0; column < lists_.columns(); ++column) {
    prefetch(column + 1, row);
    if (lists_.tile(column, row).empty()) continue;
    TileGradient tile{};
    tile.x = column * tile_side;
    tile.y = row * tile_side;
    std::fill_n(tile.transmittance, tile_pixels, -1.0f);
    for_each_run(tile.x, tile.y, view_.width, view_.height,
                 [&](std::size_t at, std::size_t pixel, std::size_t count) {
                   for (std::size_t i = 0; i < count; ++i) {
                     const float* value = planes.data() + pixel + i;
                     const float* by = gradient.data() + pixel + i;
                     tile.red[at + i] = by[0];
                     tile.green[at + i] = by[pixels_a_plane];
                     tile.blue[at + i] = by[2 * pixels_a_plane];
                     tile.behind[at + i] = by[0] * value[0] +
                                           by[pixels_a_plane] * value[pixels_a_plane] +
                                           by[2 * pixels_a_plane] * value[2 * pixels_a_plane];
                     tile.transmittance[at + i] = 1;
                   }
                 });
    blend_gaussians_backward(view_, entries_, lists_.tile(column, row),
                             lists_.pair_numbers(column, row), kept.records[std::size_t(column)],
                             tile, kept.scratch, moments_);
  }
}

GaussianBackwardInput GaussianRaster::backward(std::span<const float> planes,
                                               std::span<const float> gradient) {
  const Stopwatch watch(times_.backward);
  moments_.resize(lists_.pairs());
  pool_.run(rows_.size(), [&](std::size_t row) { draw_row_backward(int(row), planes, gradient); });
  times_.pairs += lists_.pairs();
  return {view_, degree_, ranges_, moments_};
}

}  // namespace tureen::trainer
