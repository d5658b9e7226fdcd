#include "splatting/windows/window_kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "splatting/windows/window_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "splatting/harmonics-inl.hpp"
#include "splatting/tiles/blending-inl.hpp"
#include "splatting/windows/window_alpha-inl.hpp"
#include "splatting/windows/window_projection-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::splatting::HWY_NAMESPACE {

void project_windows_on(const ImageView& view, const ParameterRows& windows, int degree,
                        std::size_t begin, std::size_t end, ParameterRows& projected) {
  namespace out = projected_window_row;
  const auto write_color = [&](std::size_t i, const WindowCorners& at, const WindowPlane&) {
    const Vector3 color =
        harmonics_color(degree, at.center, windows.row(window_row::harmonics), windows.stride(), i);
    hn::Store(color.x, d, projected.row(out::red) + i);
    hn::Store(color.y, d, projected.row(out::green) + i);
    hn::Store(color.z, d, projected.row(out::blue) + i);
  };
  project_shapes(view, windows, begin, end, projected, write_color);
}

void blend_windows_on(const ImageView& view, std::span<const WindowEntry> entries,
                      std::span<const std::uint32_t> tile, TilePixels& pixels) {
  blend_entries(view, entries, tile, WindowAlpha{constant(1.0f / view.near)}, pixels);
}

void collect_windows_on(const ImageView& view, std::span<const WindowEntry> entries,
                        std::span<const std::uint32_t> tile, const TilePixels& pixels,
                        TileHits& hits) {
  collect_entries(
      view, entries, tile, WindowAlpha{constant(1.0f / view.near)},
      [](std::uint32_t) { return WindowDepth(); }, pixels, hits);
}

}  // namespace tureen::splatting::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tureen::splatting {

HWY_EXPORT(project_windows_on);
HWY_EXPORT(blend_windows_on);
HWY_EXPORT(collect_windows_on);

void project_windows(const ImageView& view, const ParameterRows& windows, int harmonics_degree,
                     std::size_t begin, std::size_t end, ParameterRows& projected) {
  HWY_DYNAMIC_DISPATCH(project_windows_on)(view, windows, harmonics_degree, begin, end, projected);
}

void blend_windows(const ImageView& view, std::span<const WindowEntry> entries,
                   std::span<const std::uint32_t> tile, TilePixels& pixels) {
  HWY_DYNAMIC_DISPATCH(blend_windows_on)(view, entries, tile, pixels);
}

void collect_windows(const ImageView& view, std::span<const WindowEntry> entries,
                     std::span<const std::uint32_t> tile, const TilePixels& pixels,
                     TileHits& hits) {
  HWY_DYNAMIC_DISPATCH(collect_windows_on)(view, entries, tile, pixels, hits);
}

}  // namespace tureen::splatting
#endif
