#include "splatting/windows/corner_window_kernels.hpp"

#include "splatting/kernel_rows.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "splatting/windows/corner_window_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "splatting/harmonics-inl.hpp"
#include "splatting/tiles/blending-inl.hpp"
#include "splatting/windows/window_alpha-inl.hpp"
#include "splatting/windows/window_projection-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::splatting::HWY_NAMESPACE {

void project_corner_windows_on(const ImageView& view, const ParameterRows& windows, int degree,
                               std::size_t begin, std::size_t end,
                               CornerWindowKernel::Projected& projected) {
  namespace out = projected_corner_row;
  const auto write_colors = [&](std::size_t i, const WindowCorners& at, const WindowPlane& plane) {
    Floats weights[3], largest = hn::Zero(d);
    for (std::size_t k = 0; k < 3; ++k) {
      weights[k] = hn::Mul(hn::ZeroIfNegative(at.point[k].z), plane.length[k]);
      largest = hn::Max(largest, weights[k]);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const auto store = [&](std::size_t row, Floats value) {
        hn::Store(value, d, projected.row(row + k) + i);
      };
      const std::size_t first = window_row::harmonics + k * harmonics_rows(degree);
      const Vector3 color =
          harmonics_color(degree, at.offset[k], windows.row(first), windows.stride(), i);
      const Floats weight = hn::Div(weights[k], largest);
      store(out::weights, weight);
      store(out::red, hn::Mul(weight, color.x));
      store(out::green, hn::Mul(weight, color.y));
      store(out::blue, hn::Mul(weight, color.z));
    }
  };
  project_shapes(view, windows, begin, end, projected, write_colors);
}

/// `color_of` of blend_entries().
struct CornerColor {
  HWY_INLINE Vector3 operator()(const CornerWindowEntry& entry, Floats x, Floats y) const {
    const WindowAt at(entry, x, y);
    // Of factors of the corners, by their distances.
    const auto sum = [&](const float(&of_corners)[3]) {
      return hn::MulAdd(at.distance[0], constant(of_corners[0]),
                        hn::MulAdd(at.distance[1], constant(of_corners[1]),
                                   hn::Mul(at.distance[2], constant(of_corners[2]))));
    };
    // The comparison is false for NaN, which pixels outside of the window may have.
    const Floats all = sum(entry.weights), zero = hn::Zero(d);
    const Floats by_all = hn::Div(constant(1.0f), all);
    const auto mean = [&](const float(&of_corners)[3]) {
      const Floats value = hn::Mul(sum(of_corners), by_all);
      return hn::IfThenElseZero(hn::Gt(value, zero), hn::Min(value, constant(65504.0f)));
    };
    return {mean(entry.red), mean(entry.green), mean(entry.blue)};
  }
};

struct CornerWindowLoops : WindowLoops {
  using Entry = CornerWindowEntry;
  using ColorOf = CornerColor;
};

const KernelFunctions<CornerWindowKernel>& corner_window_functions() {
  static constexpr KernelFunctions<CornerWindowKernel> functions{
      &project_corner_windows_on, &blend_on<CornerWindowLoops>, &collect_on<CornerWindowLoops>};
  return functions;
}

}  // namespace tureen::splatting::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tureen::splatting {

HWY_EXPORT(corner_window_functions);

const KernelFunctions<CornerWindowKernel>& CornerWindowKernel::functions() {
  return HWY_DYNAMIC_DISPATCH(corner_window_functions)();
}

}  // namespace tureen::splatting
#endif
