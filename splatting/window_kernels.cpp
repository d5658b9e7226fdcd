#include "splatting/window_kernels.hpp"

#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "splatting/window_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "splatting/blending-inl.hpp"
#include "splatting/harmonics-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace tureen::splatting::HWY_NAMESPACE {

/// A vector from the eye in view coordinates, x and y times the focal lengths: the homogeneous
/// image point, in pixels from the principal point.
HWY_INLINE Vector3 in_pixels(const ImageView& view, const Vector3& from_eye) {
  const Vector3 v = product(view.view_from_layer, from_eye);
  return {hn::Mul(v.x, constant(view.fx)), hn::Mul(v.y, constant(view.fy)), v.z};
}

HWY_INLINE Floats mean(Floats a, Floats b, Floats c) {
  return hn::Mul(hn::Add(hn::Add(a, b), c), constant(1.0f / 3.0f));
}

/// Linear functions of the image: projected_window_row::edges and inverse_depth.
struct WindowPlane {
  Floats edges[9], inverse_depth[3];
  Mask exists;  // in front of the eye, and with an area in the image
};

/// Of the window with these corners in layer coordinates, relative to the eye, and in
/// pixels, in the same unit of length. The functions are around (x, y), in pixels from the
/// principal point.
///
/// The homogeneous rule (docs/numerics.md, W14): with N_k = Q_i x Q_j and W = sum_k w_k |N_k.xy|,
/// the distance from edge k over the inradius at the image point p is W (N_k . p) /
/// (det |N_k.xy|), and one over the depth sum_k (N_k . p) / det.
HWY_INLINE WindowPlane plane_of(const ImageView& view, const Vector3 (&corner)[3],
                                const Vector3 (&offset)[3], const Vector3 (&point)[3], Floats x,
                                Floats y) {
  const Floats zero = hn::Zero(d);
  WindowPlane result;
  result.exists = hn::Eq(zero, zero);
  Floats distance[3];  // squared, from the eye
  for (std::size_t k = 0; k < 3; ++k) distance[k] = dot(offset[k], offset[k]);
  Floats normal_x[3], normal_y[3], at_center[3], length[3];
  Floats weight = zero, normal_sum_x = zero, normal_sum_y = zero;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t from = (k + 1) % 3, to = (k + 2) % 3;
    // Differences of the stored corners are more exact than those of the points.
    const Vector3 edge = in_pixels(
        view, {hn::Sub(corner[to].x, corner[from].x), hn::Sub(corner[to].y, corner[from].y),
               hn::Sub(corner[to].z, corner[from].z)});
    // Either end may stand for the edge's line; the nearer one has the smaller rounding.
    const Mask from_is_nearer = hn::Lt(distance[from], distance[to]);
    const auto nearer = [&](Floats a, Floats b) { return hn::IfThenElse(from_is_nearer, a, b); };
    const Vector3 start{nearer(point[from].x, point[to].x), nearer(point[from].y, point[to].y),
                        nearer(point[from].z, point[to].z)};
    normal_x[k] = hn::MulSub(start.y, edge.z, hn::Mul(start.z, edge.y));
    normal_y[k] = hn::MulSub(start.z, edge.x, hn::Mul(start.x, edge.z));
    // N_k . (x, y, 1), with both points relative to (x, y) first: this cancels less.
    const Floats ax = hn::NegMulAdd(x, start.z, start.x), ay = hn::NegMulAdd(y, start.z, start.y);
    const Floats bx = hn::NegMulAdd(x, edge.z, edge.x), by = hn::NegMulAdd(y, edge.z, edge.y);
    at_center[k] = hn::MulSub(ax, by, hn::Mul(ay, bx));
    length[k] = hn::Sqrt(hn::MulAdd(normal_x[k], normal_x[k], hn::Mul(normal_y[k], normal_y[k])));
    weight = hn::MulAdd(point[k].z, length[k], weight);
    result.exists = hn::And(result.exists, hn::Gt(length[k], zero));
    normal_sum_x = hn::Add(normal_sum_x, normal_x[k]);
    normal_sum_y = hn::Add(normal_sum_y, normal_y[k]);
  }
  // Three times N_k . centre, for any k; the edge opposite the farthest corner rounds least.
  const Floats opposite_farthest =
      hn::IfThenElse(hn::Gt(distance[0], hn::Max(distance[1], distance[2])), at_center[0],
                     hn::IfThenElse(hn::Gt(distance[1], distance[2]), at_center[1], at_center[2]));
  const Floats determinant =
      hn::Mul(hn::Add(hn::Add(point[0].z, point[1].z), point[2].z), opposite_farthest);
  result.exists = hn::And(result.exists, hn::Gt(weight, zero));
  result.exists = hn::And(result.exists, hn::Gt(hn::Abs(determinant), zero));

  const Floats inverse = hn::Div(constant(1.0f), determinant);
  for (std::size_t k = 0; k < 3; ++k) {
    const Floats factor = hn::Div(hn::Mul(weight, inverse), length[k]);
    result.edges[3 * k] = hn::Mul(normal_x[k], factor);
    result.edges[3 * k + 1] = hn::Mul(normal_y[k], factor);
    result.edges[3 * k + 2] = hn::Mul(at_center[k], factor);
  }
  result.inverse_depth[0] = hn::Mul(normal_sum_x, inverse);
  result.inverse_depth[1] = hn::Mul(normal_sum_y, inverse);
  result.inverse_depth[2] =
      hn::Mul(hn::Add(hn::Add(at_center[0], at_center[1]), at_center[2]), inverse);
  return result;
}

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

void project_windows_on(const ImageView& view, const ParameterRows& windows, int degree,
                        ParameterRows& projected) {
  namespace in = window_row;
  namespace out = projected_window_row;
  const Floats zero = hn::Zero(d), one = constant(1.0f);
  for (std::size_t i = 0; i < windows.count(); i += lanes) {
    const auto load = [&](std::size_t row) { return hn::Load(d, windows.row(row) + i); };
    const auto store = [&](std::size_t row, Floats value) {
      hn::Store(value, d, projected.row(row) + i);
    };
    Vector3 corner[3], offset[3], point[3];
    Floats extent = zero;
    for (std::size_t k = 0; k < 3; ++k) {
      corner[k] = {load(in::corners + 3 * k), load(in::corners + 3 * k + 1),
                   load(in::corners + 3 * k + 2)};
      offset[k] = from_eye(view, corner[k]);
      extent = hn::Max(extent, hn::Max(hn::Abs(offset[k].x),
                                       hn::Max(hn::Abs(offset[k].y), hn::Abs(offset[k].z))));
    }
    // Fourth powers of lengths would underflow below 1e-10 and overflow beyond 1e9
    // (docs/numerics.md, E8). Homogeneous points keep their image in another unit; a power of 2
    // adds no rounding.
    const Floats size = power_of_2_in(extent), by_size = hn::Div(one, size);
    for (std::size_t k = 0; k < 3; ++k) {
      corner[k] = product(corner[k], by_size);
      offset[k] = product(offset[k], by_size);
      point[k] = in_pixels(view, offset[k]);
    }
    const Vector3 center{mean(offset[0].x, offset[1].x, offset[2].x),
                         mean(offset[0].y, offset[1].y, offset[2].y),
                         mean(offset[0].z, offset[1].z, offset[2].z)};
    const Floats relative_depth = mean(point[0].z, point[1].z, point[2].z);
    const Floats depth = hn::Mul(relative_depth, size);
    Mask drawn = hn::Gt(depth, constant(std::fmax(view.near, view.min_center_depth)));
    const Floats scale = hn::Div(one, hn::IfThenElse(drawn, relative_depth, one));
    // The image of the centre, relative to the principal point.
    const Floats x = hn::Mul(mean(point[0].x, point[1].x, point[2].x), scale);
    const Floats y = hn::Mul(mean(point[0].y, point[1].y, point[2].y), scale);

    const WindowPlane plane = plane_of(view, corner, offset, point, x, y);
    drawn = hn::And(drawn, plane.exists);
    for (std::size_t k = 0; k < 9; ++k) store(out::edges + k, plane.edges[k]);
    for (std::size_t k = 0; k < 3; ++k)
      store(out::inverse_depth + k, hn::Mul(plane.inverse_depth[k], by_size));

    const Floats opacity = load(in::opacity), sigma = load(in::sigma);
    const Floats log_opacity = log2_of(hn::IfThenElse(hn::Gt(opacity, zero), opacity, one));
    const Floats excess = hn::Sub(log_opacity, constant(std::log2(view.min_alpha)));
    drawn = hn::And(drawn, hn::And(hn::Gt(opacity, zero), hn::Gt(excess, zero)));
    // -126: exp2_of() has no smaller values.
    const Floats min_rho = exp2_of(hn::Max(hn::Neg(hn::Div(excess, sigma)), constant(-126.0f)));

    Floats outline[6];
    outline_of(view, point, hn::Mul(constant(view.near), by_size), min_rho, outline);
    for (std::size_t k = 0; k < 6; ++k) store(out::outline + k, outline[k]);

    store(out::x, hn::Add(x, constant(view.cx)));
    store(out::y, hn::Add(y, constant(view.cy)));
    store(out::sigma, sigma);
    store(out::log_opacity, log_opacity);
    store(out::min_rho, min_rho);
    store(out::depth, hn::IfThenElse(drawn, depth, not_drawn()));
    const Vector3 color =
        harmonics_color(degree, unit(center), windows.row(in::harmonics), windows.stride(), i);
    store(out::red, color.x);
    store(out::green, color.y);
    store(out::blue, color.z);
  }
}

struct WindowAlpha {
  const ImageView& view;

  /// Returns the pixels where alpha reaches the smallest value, and sets `alpha` there.
  HWY_INLINE Mask operator()(const WindowEntry& entry, Floats x, Floats y, Floats inverse_behind,
                             Floats& alpha) const {
    const Floats dx = hn::Sub(x, constant(entry.x)), dy = hn::Sub(y, constant(entry.y));
    const auto linear = [&](const float* factors) {
      return hn::MulAdd(constant(factors[0]), dx,
                        hn::MulAdd(constant(factors[1]), dy, constant(factors[2])));
    };
    const Floats rho =
        hn::Min(hn::Min(linear(entry.edges), linear(entry.edges + 3)), linear(entry.edges + 6));
    Mask covered = hn::Ge(rho, constant(entry.min_rho));
    if (hn::AllFalse(d, covered)) return covered;
    const Floats inverse_depth = linear(entry.inverse_depth);
    covered = hn::And(covered, hn::Gt(inverse_depth, inverse_behind));
    covered = hn::And(covered, hn::Lt(inverse_depth, constant(1.0f / view.near)));
    // log2_of() needs normal numbers, also where the pixel is not covered.
    const Floats log_rho = log2_of(hn::Min(hn::Max(rho, constant(1e-30f)), constant(1.0f)));
    const Floats log_alpha =
        hn::MulAdd(constant(entry.sigma), log_rho, constant(entry.log_opacity));
    alpha = exp2_of(hn::Max(log_alpha, constant(-126.0f)));
    return covered;
  }
};

void blend_windows_on(const ImageView& view, std::span<const WindowEntry> entries,
                      std::span<const std::uint32_t> tile, TilePixels& pixels) {
  blend_entries(view, entries, tile, WindowAlpha{view}, pixels);
}

}  // namespace tureen::splatting::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tureen::splatting {

HWY_EXPORT(project_windows_on);
HWY_EXPORT(blend_windows_on);

void project_windows(const ImageView& view, const ParameterRows& windows, int harmonics_degree,
                     ParameterRows& projected) {
  HWY_DYNAMIC_DISPATCH(project_windows_on)(view, windows, harmonics_degree, projected);
}

void blend_windows(const ImageView& view, std::span<const WindowEntry> entries,
                   std::span<const std::uint32_t> tile, TilePixels& pixels) {
  HWY_DYNAMIC_DISPATCH(blend_windows_on)(view, entries, tile, pixels);
}

}  // namespace tureen::splatting
#endif
