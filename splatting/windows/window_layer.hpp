// Triangle windows in the tile renderer.
#pragma once

#include <vector>

#include "splatting/layer.hpp"
#include "splatting/windows/window_entries.hpp"

namespace tureen::splatting {

/// Windows of one colour, for WindowLayer.
struct OneColorWindows {
  using Entry = WindowEntry;
  static constexpr std::size_t rows = projected_window_row::count;
  static constexpr auto project = &project_windows;
  static constexpr auto read = &read_entry;
  static constexpr auto blend = &blend_windows;
  static constexpr auto collect = &collect_windows;
};

/// Windows with colours of their corners.
struct CornerColorWindows {
  using Entry = CornerWindowEntry;
  static constexpr std::size_t rows = projected_corner_row::count;
  static constexpr auto project = &project_corner_windows;
  static constexpr auto read = &read_corner_entry;
  static constexpr auto blend = &blend_corner_windows;
  static constexpr auto collect = &collect_corner_windows;
};

/// The rows of window_row, for the windows with these indices and harmonics up to `degree`.
ParameterRows rows_of(const TriangleWindows& windows, const SplatColor& color,
                      std::span<const std::uint32_t> which, int degree);

/// `Kernel` is OneColorWindows or CornerColorWindows, as the colour says.
template <class Kernel>
class WindowLayer final : public Layer {
 public:
  explicit WindowLayer(LayerData data);

  std::span<const float> project(const ImageView& view) override;
  void set_order(std::span<const std::uint32_t> splats) override;
  void list(const ImageView& view, std::uint32_t begin, std::uint32_t end, std::uint32_t tag,
            TileLists& lists) const override;
  void blend(const ImageView& view, std::span<const std::uint32_t> splats,
             TilePixels& pixels) const override;
  void collect(const ImageView& view, std::span<const std::uint32_t> splats,
               const TilePixels& pixels, TileHits& hits) const override;

 private:
  ParameterRows projected_;
  std::vector<typename Kernel::Entry> entries_;  // in the order of blending
  std::vector<WindowOutline> outlines_;
};

extern template class WindowLayer<OneColorWindows>;
extern template class WindowLayer<CornerColorWindows>;

}  // namespace tureen::splatting
