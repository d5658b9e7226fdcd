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
                        std::size_t begin, std::size_t end, WindowKernel::Projected& projected) {
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

const KernelFunctions<WindowKernel>& window_functions() {
  static constexpr KernelFunctions<WindowKernel> functions{
      &project_windows_on, &blend_on<WindowLoops>, &collect_on<WindowLoops>};
  return functions;
}

}  // namespace tureen::splatting::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tureen::splatting {

HWY_EXPORT(window_functions);

const KernelFunctions<WindowKernel>& WindowKernel::functions() {
  return HWY_DYNAMIC_DISPATCH(window_functions)();
}

}  // namespace tureen::splatting
#endif
