// The image of a triangle window's plane. Included once for each target of Highway.
#if defined(TUREEN_WINDOW_PLANE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TUREEN_WINDOW_PLANE_INL
#undef TUREEN_WINDOW_PLANE_INL
#else
#define TUREEN_WINDOW_PLANE_INL
#endif

#include "splatting/vector_math-inl.hpp"
#include "splatting/windows/window_kernels.hpp"

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

/// The corners of windows in a view, scaled by a power of 2 so that fourth powers of lengths
/// neither underflow nor overflow (docs/numerics.md, E8). Homogeneous points keep their image in
/// another unit, and the scaling adds no rounding.
struct WindowCorners {
  Vector3 corner[3];      // in layer coordinates, scaled
  Vector3 offset[3];      // from the eye, in layer coordinates, scaled
  Vector3 point[3];       // in_pixels(), scaled
  Vector3 center;         // from the eye, scaled
  Floats relative_depth;  // of the centre, scaled
  Floats size, by_size;   // the unit, and one over it
  // A reference in the image, in pixels from the principal point: the image of the centre. With a
  // profile without min_center_depth, the point of the image nearest to that; the principal point's
  // nearest if the centre is behind the eye.
  Floats x, y;
};

/// `corner` in layer coordinates.
HWY_INLINE WindowCorners corners_of(const ImageView& view, const Vector3 (&corner)[3]) {
  const Floats zero = hn::Zero(d), one = constant(1.0f);
  WindowCorners at;
  Floats extent = zero;
  for (std::size_t k = 0; k < 3; ++k) {
    at.offset[k] = from_eye(view, corner[k]);
    extent = hn::Max(extent, hn::Max(hn::Abs(at.offset[k].x),
                                     hn::Max(hn::Abs(at.offset[k].y), hn::Abs(at.offset[k].z))));
  }
  at.size = power_of_2_in(extent);
  at.by_size = hn::Div(one, at.size);
  for (std::size_t k = 0; k < 3; ++k) {
    at.corner[k] = product(corner[k], at.by_size);
    at.offset[k] = product(at.offset[k], at.by_size);
    at.point[k] = in_pixels(view, at.offset[k]);
  }
  at.center = {mean(at.offset[0].x, at.offset[1].x, at.offset[2].x),
               mean(at.offset[0].y, at.offset[1].y, at.offset[2].y),
               mean(at.offset[0].z, at.offset[1].z, at.offset[2].z)};
  at.relative_depth = mean(at.point[0].z, at.point[1].z, at.point[2].z);
  const Mask in_front = hn::Gt(at.relative_depth, zero);
  const Floats scale = hn::Div(one, hn::IfThenElse(in_front, at.relative_depth, one));
  at.x = hn::Mul(mean(at.point[0].x, at.point[1].x, at.point[2].x), scale);
  at.y = hn::Mul(mean(at.point[0].y, at.point[1].y, at.point[2].y), scale);
  if (view.min_center_depth == 0) {
    // Far from the image, linear functions around the reference would cancel in the image.
    const auto in_image = [&](Floats at_center, float first, int length) {
      return hn::Clamp(hn::IfThenElseZero(in_front, at_center), constant(-first),
                       constant(float(length) - first));
    };
    at.x = in_image(at.x, view.cx, view.width);
    at.y = in_image(at.y, view.cy, view.height);
  }
  return at;
}

/// Linear functions of the image: projected_window_row::edges and inverse_depth.
struct WindowPlane {
  Floats edges[9], inverse_depth[3];
  Mask exists;  // in front of the eye, and with an area in the image
  // N_k.x, N_k.y, N_k . (x, y, 1), |N_k.xy|, W and det, in the unit of the corners.
  Floats normal_x[3], normal_y[3], at_reference[3], length[3], weight, determinant;
};

/// The functions are around the reference (x, y) of WindowCorners.
///
/// The homogeneous rule (docs/numerics.md, W14): with N_k = Q_i x Q_j and W = sum_k w_k |N_k.xy|,
/// the distance from edge k over the inradius at the image point p is W (N_k . p) /
/// (det |N_k.xy|), and one over the depth sum_k (N_k . p) / det.
HWY_INLINE WindowPlane plane_of(const ImageView& view, const WindowCorners& at) {
  const auto& [corner, offset, point, center, relative_depth, size, by_size, x, y] = at;
  const Floats zero = hn::Zero(d);
  WindowPlane result;
  Floats distance[3];  // squared, from the eye
  for (std::size_t k = 0; k < 3; ++k) distance[k] = dot(offset[k], offset[k]);
  auto& [edges, inverse_depth, exists, normal_x, normal_y, at_reference, length, weight,
         determinant] = result;
  exists = hn::Eq(zero, zero);
  weight = zero;
  Floats normal_sum_x = zero, normal_sum_y = zero;
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
    at_reference[k] = hn::MulSub(ax, by, hn::Mul(ay, bx));
    length[k] = hn::Sqrt(hn::MulAdd(normal_x[k], normal_x[k], hn::Mul(normal_y[k], normal_y[k])));
    weight = hn::MulAdd(point[k].z, length[k], weight);
    exists = hn::And(exists, hn::Gt(length[k], zero));
    normal_sum_x = hn::Add(normal_sum_x, normal_x[k]);
    normal_sum_y = hn::Add(normal_sum_y, normal_y[k]);
  }
  // Three times N_k . centre, for any k; the edge opposite the farthest corner rounds least.
  const auto opposite_farthest = [&](const Floats(&of_edge)[3]) {
    return hn::IfThenElse(hn::Gt(distance[0], hn::Max(distance[1], distance[2])), of_edge[0],
                          hn::IfThenElse(hn::Gt(distance[1], distance[2]), of_edge[1], of_edge[2]));
  };
  const Floats depth_sum = hn::Add(hn::Add(point[0].z, point[1].z), point[2].z);
  determinant = hn::Mul(depth_sum, opposite_farthest(at_reference));
  if (view.min_center_depth == 0) {  // the reference may not be the image of the centre
    const Floats from_x =
        hn::NegMulAdd(x, depth_sum, hn::Add(hn::Add(point[0].x, point[1].x), point[2].x));
    const Floats from_y =
        hn::NegMulAdd(y, depth_sum, hn::Add(hn::Add(point[0].y, point[1].y), point[2].y));
    determinant = hn::MulAdd(opposite_farthest(normal_x), from_x,
                             hn::MulAdd(opposite_farthest(normal_y), from_y, determinant));
  }
  exists = hn::And(exists, hn::Gt(weight, zero));
  exists = hn::And(exists, hn::Gt(hn::Abs(determinant), zero));

  const Floats inverse = hn::Div(constant(1.0f), determinant);
  for (std::size_t k = 0; k < 3; ++k) {
    const Floats factor = hn::Div(hn::Mul(weight, inverse), length[k]);
    edges[3 * k] = hn::Mul(normal_x[k], factor);
    edges[3 * k + 1] = hn::Mul(normal_y[k], factor);
    edges[3 * k + 2] = hn::Mul(at_reference[k], factor);
  }
  inverse_depth[0] = hn::Mul(normal_sum_x, inverse);
  inverse_depth[1] = hn::Mul(normal_sum_y, inverse);
  inverse_depth[2] =
      hn::Mul(hn::Add(hn::Add(at_reference[0], at_reference[1]), at_reference[2]), inverse);
  return result;
}

/// Half of the width of the ramp at the edges of solid windows, in px. Along the common edge of two
/// triangles, wide ramps show what is behind both; with narrow ones, an edge has few pixels that
/// move it. With photographs of lego at 200x200 that were held back from training, 0.5, 0.35, 0.25
/// and 0.15 give 27.4, 27.9, 28.1 and 27.9 dB with 4x4 samples.
inline constexpr float half_ramp = 0.25f;

/// How windows become opaque triangles in training. rho at the solidity s, for an inradius r in px:
///
///   rho_s = gain rho + s / 2 with gain = 1 / (1 - s + 2 s min(half_ramp / r, 1)).
///
/// Solidity 0 is the window of Triangle Splatting. Solidity 1 is a ramp from 0 to 1 across each
/// edge, from half_ramp outside of the triangle to half_ramp inside; in a small triangle, from its
/// inradius outside to the incentre, so that the integral is at most 4/3 of the area.
struct SolidRamp {
  Floats gain, by_inradius;
  Floats gain_slope;  // the derivative of gain by by_inradius
  float offset;

  HWY_INLINE SolidRamp(const ImageView& view, const WindowPlane& plane)
      : offset(0.5f * view.solidity) {
    const Floats one = constant(1.0f);
    // The gradient of rho is one over the inradius, for each edge.
    by_inradius = hn::Sqrt(
        hn::MulAdd(plane.edges[0], plane.edges[0], hn::Mul(plane.edges[1], plane.edges[1])));
    const Floats ratio = hn::Mul(by_inradius, constant(half_ramp));
    gain = hn::Div(one, hn::MulAdd(hn::Min(ratio, one), constant(2 * view.solidity),
                                   constant(1 - view.solidity)));
    gain_slope = hn::IfThenElseZero(
        hn::Lt(ratio, one), hn::Mul(constant(-2 * view.solidity * half_ramp), hn::Mul(gain, gain)));
  }
};

}  // namespace tureen::splatting::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
