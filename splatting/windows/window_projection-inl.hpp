// The projection of triangle windows. Included once for each target of Highway.
#if defined(TUREEN_WINDOW_PROJECTION_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TUREEN_WINDOW_PROJECTION_INL
#undef TUREEN_WINDOW_PROJECTION_INL
#else
#define TUREEN_WINDOW_PROJECTION_INL
#endif

#include <cmath>
#include <limits>

#include "splatting/image_sides-inl.hpp"
#include "splatting/windows/window_kernels.hpp"
#include "splatting/windows/window_plane-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::splatting::HWY_NAMESPACE {

/// projected_window_row::outline: the triangle with these corners in pixels, scaled about its
/// incenter. `near` is in the unit of the corners.
HWY_INLINE void outline_of(const ImageView& view, const Vector3 (&point)[3], Floats near,
                           Floats min_rho, Floats (&outline)[6]) {
  const Floats one = constant(1.0f), nan = constant(std::numeric_limits<float>::quiet_NaN());
  const Mask in_front = hn::Gt(hn::Min(point[0].z, hn::Min(point[1].z, point[2].z)), near);
  Floats image_x[3], image_y[3];
  for (std::size_t k = 0; k < 3; ++k) {
    const Floats by_depth = hn::Div(one, hn::IfThenElse(in_front, point[k].z, one));
    image_x[k] = hn::MulAdd(point[k].x, by_depth, constant(view.cx));
    image_y[k] = hn::MulAdd(point[k].y, by_depth, constant(view.cy));
  }
  Floats sum_x = hn::Zero(d), sum_y = hn::Zero(d), perimeter = hn::Zero(d);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t from = (k + 1) % 3, to = (k + 2) % 3;
    const Floats dx = hn::Sub(image_x[to], image_x[from]), dy = hn::Sub(image_y[to], image_y[from]);
    const Floats opposite = hn::Sqrt(hn::MulAdd(dx, dx, hn::Mul(dy, dy)));
    sum_x = hn::MulAdd(opposite, image_x[k], sum_x);
    sum_y = hn::MulAdd(opposite, image_y[k], sum_y);
    perimeter = hn::Add(perimeter, opposite);
  }
  const Floats incenter_x = hn::Div(sum_x, perimeter), incenter_y = hn::Div(sum_y, perimeter);
  const Floats shrinking = hn::Sub(one, min_rho);
  const auto shrunk = [&](Floats at, Floats middle) {
    return hn::IfThenElse(in_front, hn::MulAdd(shrinking, hn::Sub(at, middle), middle), nan);
  };
  for (std::size_t k = 0; k < 3; ++k) {
    outline[2 * k] = shrunk(image_x[k], incenter_x);
    outline[2 * k + 1] = shrunk(image_y[k], incenter_y);
  }
}

/// The rows of projected_window_row, but not red, green and blue. `write_colors(i, at, plane)`
/// writes the colours of the vector of windows from `i` on.
template <class WriteColors>
HWY_INLINE void project_shapes(const ImageView& view, const ParameterRows& windows,
                               std::size_t begin, std::size_t end, ParameterRows& projected,
                               const WriteColors& write_colors) {
  namespace in = window_row;
  namespace out = projected_window_row;
  const Floats zero = hn::Zero(d), one = constant(1.0f);
  for (std::size_t i = begin; i < end; i += lanes) {
    const auto load = [&](std::size_t row) { return hn::Load(d, windows.row(row) + i); };
    const auto store = [&](std::size_t row, Floats value) {
      hn::Store(value, d, projected.row(row) + i);
    };
    Vector3 corner[3];
    for (std::size_t k = 0; k < 3; ++k)
      corner[k] = {load(in::corners + 3 * k), load(in::corners + 3 * k + 1),
                   load(in::corners + 3 * k + 2)};
    const WindowCorners at = corners_of(view, corner);
    const Floats by_size = at.by_size;
    const Floats depth = hn::Mul(at.relative_depth, at.size);
    const WindowPlane plane = plane_of(view, at);
    Mask drawn = plane.exists;
    if (view.min_center_depth > 0) {
      drawn = hn::And(drawn, hn::Gt(depth, constant(view.min_center_depth)));
    } else {
      // Many windows cross the eye's plane beside the image; they would be in the lists of all
      // tiles.
      const auto largest_along = [&](const Vector3& normal) {
        return hn::Max(dot(normal, at.point[0]),
                       hn::Max(dot(normal, at.point[1]), dot(normal, at.point[2])));
      };
      drawn = hn::And(drawn, reach_image(view, largest_along));
    }
    const SolidRamp ramp(view, plane);
    for (std::size_t k = 0; k < 9; ++k) {
      const float offset = k % 3 == 2 ? ramp.offset : 0;
      store(out::edges + k, hn::MulAdd(ramp.gain, plane.edges[k], constant(offset)));
    }
    for (std::size_t k = 0; k < 3; ++k)
      store(out::inverse_depth + k, hn::Mul(plane.inverse_depth[k], by_size));

    const Floats opacity = load(in::opacity), sigma = load(in::sigma);
    const Floats log_opacity = log2_of(hn::IfThenElse(hn::Gt(opacity, zero), opacity, one));
    const Floats excess = hn::Sub(log_opacity, constant(std::log2(view.min_alpha)));
    drawn = hn::And(drawn, hn::And(hn::Gt(opacity, zero), hn::Gt(excess, zero)));
    // -126: exp2_of() has no smaller values.
    const Floats min_rho = exp2_of(hn::Max(hn::Neg(hn::Div(excess, sigma)), constant(-126.0f)));

    Floats outline[6];
    const Floats min_soft_rho = hn::Div(hn::Sub(min_rho, constant(ramp.offset)), ramp.gain);
    outline_of(view, at.point, hn::Mul(constant(view.near), by_size), min_soft_rho, outline);
    for (std::size_t k = 0; k < 6; ++k) store(out::outline + k, outline[k]);

    store(out::x, hn::Add(at.x, constant(view.cx)));
    store(out::y, hn::Add(at.y, constant(view.cy)));
    store(out::sigma, sigma);
    store(out::log_opacity, log_opacity);
    store(out::min_rho, min_rho);
    store(out::depth, hn::IfThenElse(drawn, depth, not_drawn()));
    write_colors(i, at, plane);
  }
}

}  // namespace tureen::splatting::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
