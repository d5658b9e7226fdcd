// The splats of one layer, as the tile renderer draws them.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/splats.hpp"
#include "splatting/image_view.hpp"
#include "splatting/parameter_rows.hpp"
#include "splatting/tiles/tile_lists.hpp"

namespace tureen::splatting {

/// The low bits of a splat in a tile's list: its place in the layer's order. The others are its
/// layer.
inline constexpr int place_bits = 24;
inline constexpr std::uint32_t place_mask = (1u << place_bits) - 1;

/// The place of a kernel in the list of layer.cpp. Discs and Gaussians are the projections of
/// Gaussians by SplatProfile::projection.
using LayerKind = std::uint8_t;

/// Everything that a layer is made from. The rows are those of the kernel's file; `degree` is that
/// of their harmonics.
struct LayerData {
  LayerKind kind = 0;
  int degree = 0;
  ParameterRows rows;
};

/// A splat at a pixel.
struct SplatHit {
  float depth;  // view depth at which the pixel's ray meets the splat, in world units
  float alpha;  // limited by the profile
  float red, green, blue;
  float stop;           // ImageView::stop_transmittance of its layer
  std::uint32_t place;  // in its layer's order
};

/// The splats at each pixel of a tile, for blending in the order along the rays.
struct TileHits {
  std::array<std::vector<SplatHit>, tile_pixels> at;
  float scale = 1;  // world units per layer unit, for hits that are added

  void clear() {
    for (std::vector<SplatHit>& hits : at) hits.clear();
  }
};

class Layer {
 public:
  explicit Layer(LayerData data) : data_(std::move(data)) {}
  virtual ~Layer() = default;
  const LayerData& data() const { return data_; }
  std::size_t count() const { return data_.rows.count(); }
  /// Computes what all pixels of a splat share, and returns the view depth of each centre, in layer
  /// units; NaN for splats that are not drawn. Valid until the next call.
  virtual std::span<const float> project(const ImageView& view) = 0;
  /// Sets the order of blending of the next calls: drawn splats, near ones first.
  virtual void set_order(std::span<const std::uint32_t> splats) = 0;
  /// Adds the splats at places [begin, end) of the order, as `tag` | place. `tag` is the layer.
  virtual void list(std::uint32_t begin, std::uint32_t end, std::uint32_t tag,
                    TileLists& lists) const = 0;
  /// Blends splats from a tile's list, all of this layer, front to back.
  virtual void blend(const ImageView& view, std::span<const std::uint32_t> splats,
                     TilePixels& pixels) const = 0;
  /// Adds the same splats at every pixel that they cover, instead of blending them. Depth is that
  /// of the largest density (Gaussians), of the plane (windows, discs) or of the middle of the
  /// chord (neural densities), as oracle/splats.hpp has it. Of `pixels`, the place and
  /// inverse_behind are used.
  virtual void collect(const ImageView& view, std::span<const std::uint32_t> splats,
                       const TilePixels& pixels, TileHits& hits) const = 0;

 private:
  LayerData data_;
};

/// Facts about a kernel, which stand in its struct (KernelFunctions, KernelOf).
struct KernelFacts {
  std::string_view shaders;
  std::span<const std::size_t> texel_rows;
  std::size_t points, colors;
  bool (*draws)(const Splats& splats, const SplatProfile& profile);
  std::unique_ptr<Layer> (*make)(LayerData&& data);
};

/// The kernel that draws the splats by this profile.
LayerKind kind_of(const Splats& splats, const SplatProfile& profile);
const KernelFacts& facts_of(LayerKind kind);

/// Whether make_layer() supports the splats: at most place_mask.
bool has_layer_for(const Splats& splats);

/// Those of the splats with these indices that have no NaN.
std::vector<std::uint32_t> without_nan(const Splats& splats, std::span<const std::uint32_t> which);

/// A copy of the splats with these indices, without those that have a NaN, for views of this
/// profile. Harmonics up to `degree` are copied. The splats fulfil has_layer_for().
LayerData layer_data(const Splats& splats, const SplatProfile& profile,
                     std::span<const std::uint32_t> which, int degree);

/// The layer that draws these data.
std::unique_ptr<Layer> make_layer(LayerData data);

}  // namespace tureen::splatting
