// The gradient of geometry: the change of the loss when a visibility edge moves.
//
// Take neighbouring pixels p and q. A boundary that moves by one pixel towards q changes the colour
// C_q into C_p. With g = dL/dC its derivative is 1/2 sum (g_p + g_q) (C_p - C_q), because the
// boundary crosses p or q with equal probability (DiffSoup, arXiv 2603.27151, supplement). The
// cases below determine the boundary and the point of p's triangle that moves it. p's side moves
// only p's triangle.
#pragma once

#include <cmath>
#include <cstdint>

#include "trainer/common/kernels/host_device.hpp"
#include "trainer/common/kernels/projection.hpp"

namespace tureen::trainer::kernels {

/// One pixel of a finished image, as input of the edge gradient.
struct EdgePixel {
  std::uint32_t face;  // no_face for the background
  float inverse_depth;
  float color[3];
  float gradient[3];  // dL/dcolour
};

enum class EdgeCase { none, texture_slide, intersection, opacity, geometric };

/// A point of p's triangle and the derivative of the loss by its motion.
struct PointGradient {
  EdgeCase kind = EdgeCase::none;
  float e[3];       // edge values there: barycentrics times the inverse depth
  float x, y;       // position on the image, in pixels
  float gx, gy;     // derivative by its motion on the image, per pixel
  float g_inverse;  // derivative by the inverse depth of p's triangle there
};

/// (qx, qy) is one of the four neighbours of (px, py). `face` is p's triangle, `other` q's
/// (ignored if q_is_background). `slide` scales the texture slide.
TUREEN_HOST_DEVICE PointGradient edge_gradient(const ProjectedFace& face,
                                               const ProjectedFace* other, int px, int py, int qx,
                                               int qy, const EdgePixel& p, const EdgePixel& q,
                                               bool q_is_background, float slide) {
  PointGradient result;
  float adjoint = 0;
  for (int c = 0; c < 3; ++c)
    adjoint += 0.5f * (p.gradient[c] + q.gradient[c]) * (p.color[c] - q.color[c]);
  // 0, or NaN: a colour that is not a number must not move the faces of its neighbours.
  if (!(adjoint < 0 || adjoint > 0)) return result;
  float at_p[3], at_q[3];
  edge_values(face, float(px), float(py), at_p);
  edge_values(face, float(qx), float(qy), at_q);
  const float inverse_q = at_q[0] + at_q[1] + at_q[2];
  const bool covers_q = at_q[0] >= 0 && at_q[1] >= 0 && at_q[2] >= 0 && inverse_q > 0;

  float t = 0.5f;  // from p to q
  if (!q_is_background && p.face == q.face) {
    result.kind = EdgeCase::texture_slide;
    adjoint *= slide;
  } else if (covers_q && !q_is_background && q.inverse_depth > inverse_q) {
    // q's triangle is in front at q. The case is an intersection if it lies behind at p.
    float other_p[3];
    edge_values(*other, float(px), float(py), other_p);
    const float other_inverse_p = other_p[0] + other_p[1] + other_p[2];
    const bool covers_p = other_p[0] >= 0 && other_p[1] >= 0 && other_p[2] >= 0;
    if (!covers_p || !(other_inverse_p < p.inverse_depth)) return result;
    // Along pq the inverse depths are affine. They cross at t, and t moves by 1 / slope for each
    // unit of inverse depth that p's triangle gains. Horizontal and vertical pairs each see the
    // full motion of a slanted line. They share it by the squares of its normal's components,
    // slope^2 / |gradient|^2.
    const float ahead = p.inverse_depth - other_inverse_p, behind = q.inverse_depth - inverse_q;
    const float slope = ahead + behind;
    float across = 0, down = 0;
    for (int k = 0; k < 3; ++k) {
      across += face.dx[k] - other->dx[k];
      down += face.dy[k] - other->dy[k];
    }
    const float squared = across * across + down * down;
    // `slope` is one component of that gradient. Where faces meet, its square exceeds the squared
    // gradient only by rounding errors, far less than a factor of 2. A larger ratio comes from
    // rounding errors alone: the two faces lie in one plane, rounding decides which is in front,
    // and no line moves.
    if (!(slope * slope < 2 * squared)) return result;
    result.kind = EdgeCase::intersection;
    t = ahead / slope;
    result.g_inverse = adjoint * slope / squared;
  } else if (covers_q) {
    result.kind = EdgeCase::opacity;  // nearer than the visible face at q, but not accepted there
  } else if (q_is_background || p.inverse_depth > q.inverse_depth) {
    result.kind = EdgeCase::geometric;
    // The first edge of the triangle on the segment from p to q.
    t = 1;
    for (int k = 0; k < 3; ++k)
      if (at_q[k] < 0) {
        const float crossing = at_p[k] / (at_p[k] - at_q[k]);
        t = crossing < t ? crossing : t;
      }
  } else {
    return result;
  }
  for (int k = 0; k < 3; ++k) {
    const float e = at_p[k] + t * (at_q[k] - at_p[k]);
    result.e[k] = e > 0 ? e : 0;
  }
  result.x = float(px) + 0.5f + t * float(qx - px);
  result.y = float(py) + 0.5f + t * float(qy - py);
  if (result.kind == EdgeCase::intersection) {
    result.gx = result.gy = 0;
  } else {
    result.gx = adjoint * float(qx - px);
    result.gy = adjoint * float(qy - py);
    result.g_inverse = 0;
  }
  return result;
}

/// Adds the gradient of one point to the derivatives by the triangle's corners, in the view's axes
/// right, down, forward. The corners share it by their barycentrics there.
TUREEN_HOST_DEVICE void distribute(const View& view, const ProjectedFace& face,
                                   const PointGradient& point, float (&corners)[3][3]) {
  const float inverse_depth = point.e[0] + point.e[1] + point.e[2];
  if (!(inverse_depth > 0)) return;
  const float x = point.x - float(view.cx), y = point.y - float(view.cy);
  float g[3];
  if (point.kind == EdgeCase::intersection) {
    // The inverse depth is affine in the pixel. In view coordinates the face's plane is N . v = 1
    // with N = (fx sum dx, fy sum dy, inverse depth on the axis). A shift d of the point changes
    // 1/w on a fixed pixel by -N.d / w.
    const float sx = face.dx[0] + face.dx[1] + face.dx[2];
    const float sy = face.dy[0] + face.dy[1] + face.dy[2];
    const float axis = inverse_depth - sx * x - sy * y;
    const float scale = -point.g_inverse * inverse_depth;
    g[0] = scale * sx * float(view.fx);
    g[1] = scale * sy * float(view.fy);
    g[2] = scale * axis;
  } else {
    g[0] = inverse_depth * float(view.fx) * point.gx;
    g[1] = inverse_depth * float(view.fy) * point.gy;
    g[2] = -inverse_depth * (point.gx * x + point.gy * y);
  }
  const float w = 1 / inverse_depth;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) corners[i][j] += point.e[i] * w * g[j];
}

}  // namespace tureen::trainer::kernels
