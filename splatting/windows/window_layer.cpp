#include "splatting/windows/window_layer.hpp"

#include <utility>

#include "splatting/harmonics_rows.hpp"

namespace tureen::splatting {

ParameterRows rows_of(const TriangleWindows& windows, const SplatColor& color,
                      std::span<const std::uint32_t> which, int degree) {
  const std::size_t colors = color.per_corner ? 3 : 1;
  ParameterRows rows(window_row::harmonics + colors * harmonics_rows(degree), which.size());
  for (std::size_t i = 0; i < which.size(); ++i) {
    for (std::size_t k = 0; k < 9; ++k)
      rows.row(window_row::corners + k)[i] = windows.corners[3 * which[i] + k / 3][int(k % 3)];
    rows.row(window_row::sigma)[i] = windows.sigma[which[i]];
    rows.row(window_row::opacity)[i] = windows.opacity[which[i]];
  }
  write_harmonics(color, which, degree, rows, window_row::harmonics);
  return rows;
}

template <class Kernel>
WindowLayer<Kernel>::WindowLayer(LayerData data)
    : Layer(std::move(data)), projected_(Kernel::rows, count()) {}

template <class Kernel>
std::span<const float> WindowLayer<Kernel>::project(const ImageView& view) {
  Kernel::project(view, data().rows, data().degree, 0, count(), projected_);
  return {projected_.row(projected_window_row::depth), count()};
}

template <class Kernel>
void WindowLayer<Kernel>::set_order(std::span<const std::uint32_t> splats) {
  entries_.resize(splats.size());
  outlines_.resize(splats.size());
  for (std::size_t place = 0; place < splats.size(); ++place)
    Kernel::read(projected_, splats[place], entries_[place], outlines_[place]);
}

template <class Kernel>
void WindowLayer<Kernel>::list(const ImageView&, std::uint32_t begin, std::uint32_t end,
                               std::uint32_t tag, TileLists& lists) const {
  for (std::uint32_t place = begin; place < end; ++place)
    list_window(outlines_[place], tag | place, lists);
}

template <class Kernel>
void WindowLayer<Kernel>::blend(const ImageView& view, std::span<const std::uint32_t> splats,
                                TilePixels& pixels) const {
  Kernel::blend(view, entries_, splats, pixels);
}

template <class Kernel>
void WindowLayer<Kernel>::collect(const ImageView& view, std::span<const std::uint32_t> splats,
                                  const TilePixels& pixels, TileHits& hits) const {
  Kernel::collect(view, entries_, splats, pixels, hits);
}

template class WindowLayer<OneColorWindows>;
template class WindowLayer<CornerColorWindows>;

}  // namespace tureen::splatting
