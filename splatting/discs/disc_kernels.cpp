#include "splatting/discs/disc_kernels.hpp"

#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "splatting/discs/disc_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "splatting/discs/disc_alpha-inl.hpp"
#include "splatting/discs/disc_plane-inl.hpp"
#include "splatting/harmonics-inl.hpp"
#include "splatting/rotation-inl.hpp"
#include "splatting/tiles/blending-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::splatting::HWY_NAMESPACE {

/// The range of one image coordinate of a disc up to `radius` deviations, and of its screen filter
/// up to `screen` pixels. `along` is of_x or of_y of the plane, `origin` x or y. Discs that are not
/// `bounded` reach the near plane and may cover any pixel.
HWY_INLINE void bounds_of(const Vector3& along, const Vector3& of_w, Floats origin, Floats radius,
                          Floats screen, Mask bounded, Floats& low, Floats& high) {
  const auto scaled = [&](const Vector3& axis) {
    return Vector3{hn::Mul(radius, axis.x), hn::Mul(radius, axis.y), hn::Zero(d)};
  };
  range_of(scaled(along), scaled(of_w), of_w.z, low, high);
  const auto bound = [&](Floats at, float side) {
    // Half a pixel more, for rounding.
    return hn::IfThenElse(bounded, hn::Add(hn::Add(origin, at), constant(0.5f * side)),
                          constant(1e9f * side));
  };
  low = bound(hn::Min(low, hn::Neg(screen)), -1);
  high = bound(hn::Max(high, screen), 1);
}

void project_discs_on(const ImageView& view, const ParameterRows& discs, int degree,
                      std::size_t begin, std::size_t end, DiscKernel::Projected& projected) {
  namespace in = gaussian_row;
  namespace out = projected_disc_row;
  const Floats zero = hn::Zero(d), one = constant(1.0f), near = constant(view.near);
  for (std::size_t i = begin; i < end; i += lanes) {
    const auto load = [&](std::size_t row) { return hn::Load(d, discs.row(row) + i); };
    const auto store = [&](std::size_t row, Floats value) {
      hn::Store(value, d, projected.row(row) + i);
    };
    const Vector3 offset = from_eye(view, {load(in::x), load(in::y), load(in::z)});
    const Vector3 center = product(view.view_from_layer, offset);
    const Mask in_front = hn::Gt(center.z, near);
    const Rotation rotation = rotation_of(load(in::rotation_x), load(in::rotation_y),
                                          load(in::rotation_z), load(in::rotation_w));
    const auto scaled_axis = [&](std::size_t k) {
      return product(product(view.view_from_layer, rotation.axes[k]), load(in::scale_x + k));
    };
    const DiscPlane plane = plane_of(view, center, scaled_axis(0), scaled_axis(1), in_front);

    const Floats opacity = load(in::opacity);
    const Mask visible = hn::Gt(opacity, zero);
    const Floats log_opacity = log2_of(hn::IfThenElse(visible, opacity, one));
    const Floats excess = hn::Sub(log_opacity, constant(std::log2(view.min_alpha)));
    const Floats radius = hn::Sqrt(hn::Div(hn::Max(excess, zero), constant(half_log2_e)));
    // How far the disc extends along the viewing axis.
    const Floats reach = hn::Mul(radius, hn::Sqrt(hn::MulAdd(plane.of_w.x, plane.of_w.x,
                                                             hn::Mul(plane.of_w.y, plane.of_w.y))));
    Mask drawn = hn::And(visible, hn::Ge(excess, zero));
    if (view.min_center_depth > 0)
      drawn = hn::And(drawn, hn::Gt(center.z, constant(view.min_center_depth)));
    drawn = hn::And(drawn,
                    view.screen_variance > 0 ? in_front : hn::Gt(hn::Add(center.z, reach), near));

    const Mask bounded = hn::Gt(hn::Sub(center.z, reach), near);
    const Floats screen = hn::Mul(radius, constant(std::sqrt(view.screen_variance)));
    Floats left, right, top, bottom;
    bounds_of(plane.of_x, plane.of_w, plane.x, radius, screen, bounded, left, right);
    bounds_of(plane.of_y, plane.of_w, plane.y, radius, screen, bounded, top, bottom);
    store(out::left, left);
    store(out::right, right);
    store(out::top, top);
    store(out::bottom, bottom);

    store(out::x, plane.x);
    store(out::y, plane.y);
    const auto store_row = [&](std::size_t u, std::size_t v, std::size_t c, const Vector3& row) {
      store(u, row.x);
      store(v, row.y);
      store(c, row.z);
    };
    store_row(out::u_x, out::v_x, out::c_x, plane.of_x);
    store_row(out::u_y, out::v_y, out::c_y, plane.of_y);
    store_row(out::u_w, out::v_w, out::c_w, plane.of_w);
    store(out::log_opacity, log_opacity);
    store(out::depth, hn::IfThenElse(drawn, center.z, not_drawn()));
    const Vector3 color =
        harmonics_color(degree, offset, discs.row(in::harmonics), discs.stride(), i);
    store(out::red, color.x);
    store(out::green, color.y);
    store(out::blue, color.z);
  }
}

struct DiscLoops {
  using Entry = DiscEntry;
  using ColorOf = OneColor;
  static HWY_INLINE DiscAlpha alpha_of(const ImageView& view) {
    return {std::log2(view.min_alpha), disc_constants(view)};
  }
  static HWY_INLINE auto depth_of(const ImageView& view, const ParameterRows&,
                                  std::span<const std::uint32_t>) {
    return [&view](std::uint32_t) { return DiscDepth{disc_constants(view)}; };
  }
};

const KernelFunctions<DiscKernel>& disc_functions() {
  static constexpr KernelFunctions<DiscKernel> functions{&project_discs_on, &blend_on<DiscLoops>,
                                                         &collect_on<DiscLoops>};
  return functions;
}

}  // namespace tureen::splatting::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tureen::splatting {

HWY_EXPORT(disc_functions);

const KernelFunctions<DiscKernel>& DiscKernel::functions() {
  return HWY_DYNAMIC_DISPATCH(disc_functions)();
}

void DiscKernel::read(const Projected& projected, std::size_t i, Entry& entry, Outline& outline) {
  namespace row = projected_disc_row;
  const auto value = [&](std::size_t which) { return projected.row(which)[i]; };
  entry = {value(row::x),   value(row::y),     value(row::u_x), value(row::v_x),
           value(row::c_x), value(row::u_y),   value(row::v_y), value(row::c_y),
           value(row::u_w), value(row::v_w),   value(row::c_w), value(row::log_opacity),
           value(row::red), value(row::green), value(row::blue)};
  outline = {value(row::left), value(row::right), value(row::top), value(row::bottom)};
}

}  // namespace tureen::splatting
#endif
