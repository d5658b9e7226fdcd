// Draws splats on the processor, tile by tile: projects them, orders them by the view depth of
// their centres, sorts them into tiles by their outlines, and blends each tile front to back by the
// rules of their profile. Or collects the splats at each pixel, and orders those.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "splatting/depth_order.hpp"
#include "splatting/layer.hpp"

namespace tureen::splatting {

/// Calls body(0) .. body(count - 1), in any order, perhaps in several threads.
using Parallel =
    std::function<void(std::size_t count, const std::function<void(std::size_t)>& body)>;

/// Which of two splats at a pixel is in front.
enum class BlendOrder {
  /// By the view depth of the centres; at equal depths the earlier layer, then the lower index.
  centers,
  /// By the depth along the pixel's ray (SplatHit); at equal depths as `centers`.
  along_rays,
};

/// Takes consecutive rows of an image from `first_row` on; row 0 is on top. `rgba`: premultiplied
/// colours, which may exceed 1, and alpha, 4 floats a pixel; valid during the call. Several threads
/// may call it. It must not draw with a TileRenderer.
using RowSink = std::function<void(int first_row, std::span<const float> rgba)>;

/// A visible layer and its camera.
struct LayerInView {
  Layer* layer;
  ImageView view;
  double scale;  // world units per layer unit
};

class TileRenderer {
 public:
  explicit TileRenderer(Parallel parallel) : parallel_(std::move(parallel)) {}

  /// At most 255 layers, whose views have one size. `depths`: of the opaque surface in world units,
  /// a pixel, infinity where there is none; row 0 on top; or empty. Gives each row to `sink` once,
  /// in any order. The result does not depend on the number of threads.
  void draw(std::span<const LayerInView> layers, std::span<const float> depths, const RowSink& sink,
            BlendOrder order = BlendOrder::centers);

  /// What add_weights() has counted in an image.
  struct Overdraw {
    std::uint64_t pixels = 0;   // with at least one splat
    std::uint64_t blended = 0;  // pairs of such a pixel and a splat before the pixel is saturated
  };
  /// Adds to weights[i] what splat i of the layer contributes to the image: the sum over the pixels
  /// of its alpha times the transmittance of the splats in front. Nothing opaque is behind. Uses
  /// one thread. Slower than draw().
  Overdraw add_weights(const LayerInView& layer, std::span<double> weights);

 private:
  /// Consecutive splats of one layer in the order, by their places in orders_[layer].
  struct Run {
    std::uint32_t layer, begin, end;
  };
  void sort(std::span<const LayerInView> layers);
  /// `rgba`: the pixels of the row of tiles.
  void draw_tile(std::span<const LayerInView> layers, std::span<const float> depths, int column,
                 int row, TileHits* hits, std::span<float> rgba) const;

  Parallel parallel_;
  DepthOrder order_;
  std::vector<std::vector<std::uint32_t>> orders_;  // of the layers
  std::vector<Run> runs_;
  TileLists lists_;
};

}  // namespace tureen::splatting
