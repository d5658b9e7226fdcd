#include "splatting/tiles/tile_renderer.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <memory>
#include <optional>

namespace tureen::splatting {

namespace {

/// Column and row of a pixel in its tile, by its index in TilePixels.
struct TilePosition {
  int column, row;
};
TilePosition position_in_tile(int pixel) {
  constexpr int blocks_a_side = tile_side / block_side;
  const int block = pixel / block_pixels, inside = pixel % block_pixels;
  return {block_side * (block % blocks_a_side) + inside % block_side,
          block_side * (block / blocks_a_side) + inside / block_side};
}

/// Blends the splats at pixel `i`. They come in the order of the centres, which is kept at equal
/// depths.
void blend_in_order(std::vector<SplatHit>& hits, int i, TilePixels& pixels) {
  std::stable_sort(hits.begin(), hits.end(),
                   [](const SplatHit& a, const SplatHit& b) { return a.depth < b.depth; });
  for (const SplatHit& hit : hits) {
    const float transmittance = pixels.transmittance[i];
    const float behind = transmittance * (1 - hit.alpha);
    if (behind < hit.stop) return;
    const float weight = transmittance * hit.alpha;
    pixels.red[i] += weight * hit.red;
    pixels.green[i] += weight * hit.green;
    pixels.blue[i] += weight * hit.blue;
    pixels.transmittance[i] = behind;
  }
}

}  // namespace

void TileRenderer::sort(std::span<const LayerInView> layers) {
  order_.begin();
  for (const LayerInView& each : layers) {
    const std::span<const float> depths = each.layer->project(each.view);
    order_.add_layer(depths.size(), [&](std::uint32_t i) {
      return static_cast<float>(each.scale * double(depths[i]));
    });
  }
  order_.sort();
  order_.make_runs();

  orders_.resize(layers.size());
  for (std::vector<std::uint32_t>& order : orders_) order.clear();
  runs_.clear();
  for (const SplatRun& run : order_.runs()) {
    const auto splats = order_.splats().subspan(run.first, run.count);
    std::vector<std::uint32_t>& order = orders_[run.layer];
    const auto place = static_cast<std::uint32_t>(order.size());
    order.insert(order.end(), splats.begin(), splats.end());
    runs_.push_back({run.layer, place, place + run.count});
  }
  for (std::size_t i = 0; i < layers.size(); ++i) layers[i].layer->set_order(orders_[i]);
}

void TileRenderer::draw(std::span<const LayerInView> layers, std::span<const float> depths,
                        const RowSink& sink, BlendOrder order) {
  assert(!layers.empty() && layers.size() <= 255);
  const ImageView& image = layers.front().view;
  sort(layers);
  lists_.begin(image.width, image.height);
  for (const Run& run : runs_)
    layers[run.layer].layer->list(run.begin, run.end, run.layer << place_bits, lists_);
  parallel_(std::size_t(lists_.rows()), [&](std::size_t row) {
    lists_.finish(int(row));
    std::optional<TileHits> hits;
    if (order == BlendOrder::along_rays) hits.emplace();
    // A row of tiles stays in the cache until the sink has read it. Memory is kept: a new block of
    // this size would cost page faults.
    thread_local std::vector<float> kept;
    const int first_row = int(row) * tile_side;
    const auto rows = std::size_t(std::min(tile_side, image.height - first_row));
    kept.resize(std::max(kept.size(), 4 * rows * std::size_t(image.width)));
    const std::span<float> rgba = std::span(kept).first(4 * rows * std::size_t(image.width));
    for (int column = 0; column < lists_.columns(); ++column)
      draw_tile(layers, depths, column, int(row), hits ? &*hits : nullptr, rgba);
    sink(first_row, rgba);
  });
}

void TileRenderer::draw_tile(std::span<const LayerInView> layers, std::span<const float> depths,
                             int column, int row, TileHits* hits, std::span<float> rgba) const {
  const ImageView& image = layers.front().view;
  if (lists_.tile(column, row).empty()) {
    const int x = column * tile_side, width = std::min(tile_side, image.width - x);
    for (std::size_t at = std::size_t(x); 4 * at < rgba.size(); at += std::size_t(image.width))
      std::fill_n(&rgba[4 * at], 4 * width, 0.0f);
    return;
  }
  TilePixels pixels{};
  pixels.x = column * tile_side;
  pixels.y = row * tile_side;
  const auto for_each_pixel = [&](const auto& act) {
    for (int i = 0; i < tile_pixels; ++i) {
      const auto [x, y] = position_in_tile(i);
      if (pixels.x + x < image.width && pixels.y + y < image.height)
        act(i, std::size_t(pixels.y + y) * std::size_t(image.width) + std::size_t(pixels.x + x));
    }
  };
  std::fill_n(pixels.transmittance, tile_pixels, 1.0f);
  for (std::span<const std::uint32_t> rest = lists_.tile(column, row); !rest.empty();) {
    const std::uint32_t layer = rest.front() >> place_bits;
    const auto end = layers.size() == 1
                         ? rest.end()
                         : std::find_if(rest.begin(), rest.end(), [&](std::uint32_t splat) {
                             return splat >> place_bits != layer;
                           });
    const LayerInView& in_view = layers[layer];
    if (!depths.empty())
      for_each_pixel([&](int i, std::size_t pixel) {
        pixels.inverse_behind[i] = static_cast<float>(in_view.scale / double(depths[pixel]));
      });
    const auto splats = static_cast<std::size_t>(end - rest.begin());
    if (hits) {
      hits->scale = static_cast<float>(in_view.scale);
      in_view.layer->collect(in_view.view, rest.first(splats), pixels, *hits);
    } else {
      in_view.layer->blend(in_view.view, rest.first(splats), pixels);
    }
    rest = rest.subspan(splats);
  }
  if (hits) {
    for (int i = 0; i < tile_pixels; ++i) blend_in_order(hits->at[std::size_t(i)], i, pixels);
    hits->clear();
  }
  const std::size_t before = std::size_t(pixels.y) * std::size_t(image.width);
  for_each_pixel([&](int i, std::size_t pixel) {
    float* out = &rgba[4 * (pixel - before)];
    out[0] = pixels.red[i];
    out[1] = pixels.green[i];
    out[2] = pixels.blue[i];
    out[3] = 1.0f - std::abs(pixels.transmittance[i]);
  });
}

TileRenderer::Overdraw TileRenderer::add_weights(const LayerInView& layer,
                                                 std::span<double> weights) {
  assert(weights.size() == layer.layer->count());
  const std::span layers(&layer, 1);
  sort(layers);
  lists_.begin(layer.view.width, layer.view.height);
  for (const Run& run : runs_) layer.layer->list(run.begin, run.end, 0, lists_);
  const auto hits = std::make_unique<TileHits>();
  Overdraw overdraw;
  for (int row = 0; row < lists_.rows(); ++row) {
    lists_.finish(row);
    for (int column = 0; column < lists_.columns(); ++column) {
      TilePixels pixels{};
      pixels.x = column * tile_side;
      pixels.y = row * tile_side;
      layer.layer->collect(layer.view, lists_.tile(column, row), pixels, *hits);
      for (int i = 0; i < tile_pixels; ++i) {
        const TilePosition at = position_in_tile(i);
        if (pixels.x + at.column >= layer.view.width || pixels.y + at.row >= layer.view.height)
          continue;
        float transmittance = 1;
        overdraw.pixels += hits->at[std::size_t(i)].empty() ? 0 : 1;
        for (const SplatHit& hit : hits->at[std::size_t(i)]) {
          const float behind = transmittance * (1 - hit.alpha);
          if (behind < hit.stop) break;
          ++overdraw.blended;
          weights[orders_.front()[hit.place]] += double(transmittance - behind);
          transmittance = behind;
        }
      }
      hits->clear();
    }
  }
  return overdraw;
}

}  // namespace tureen::splatting
