#include "splatting/window_layer.hpp"

#include "splatting/harmonics_rows.hpp"

namespace tureen::splatting {

WindowLayer::WindowLayer(const TriangleWindows& windows, const SplatColor& color,
                         std::span<const std::uint32_t> which, int degree)
    : degree_(degree),
      rows_(window_row::harmonics + harmonics_rows(degree), which.size()),
      projected_(projected_window_row::count, which.size()) {
  for (std::size_t i = 0; i < which.size(); ++i) {
    for (std::size_t k = 0; k < 9; ++k)
      rows_.row(window_row::corners + k)[i] = windows.corners[3 * which[i] + k / 3][int(k % 3)];
    rows_.row(window_row::sigma)[i] = windows.sigma[which[i]];
    rows_.row(window_row::opacity)[i] = windows.opacity[which[i]];
  }
  write_harmonics(color, which, degree, rows_, window_row::harmonics);
}

std::span<const float> WindowLayer::project(const ImageView& view) {
  project_windows(view, rows_, degree_, 0, count(), projected_);
  return {projected_.row(projected_window_row::depth), count()};
}

void WindowLayer::set_order(std::span<const std::uint32_t> splats) {
  entries_.resize(splats.size());
  outlines_.resize(splats.size());
  for (std::size_t place = 0; place < splats.size(); ++place)
    read_entry(projected_, splats[place], entries_[place], outlines_[place]);
}

void WindowLayer::list(const ImageView&, std::uint32_t begin, std::uint32_t end, std::uint32_t tag,
                       TileLists& lists) const {
  for (std::uint32_t place = begin; place < end; ++place)
    list_window(outlines_[place], tag | place, lists);
}

void WindowLayer::blend(const ImageView& view, std::span<const std::uint32_t> splats,
                        TilePixels& pixels) const {
  blend_windows(view, entries_, splats, pixels);
}

}  // namespace tureen::splatting
