// The edge functions of a triangle on the image.
//
// View coordinates are x right, y down, w forward. With P_i = (fx x + cx w, fy y + cy w, w) and the
// determinant D = P0 . (P1 x P2), e_k(p) = (P_{k+1} x P_{k+2}) . (p, 1) / D is affine in the pixel
// p. At a point of the triangle e_k = b_k / w: the sum is 1 / w, and e_k divided by the sum is the
// perspective-correct barycentric (Olano and Greer, "Triangle scan conversion using 2D homogeneous
// coordinates", 1997). Vertices behind the eye need no clipping: a pixel is hit if all e_k >= 0 and
// 1 / w lies between the values at the far and the near plane.
#pragma once

#include <cmath>
#include <cstdint>

#include "trainer/common/kernels/host_device.hpp"

namespace tureen::trainer::kernels {

/// Maximum width and height of images: a ProjectedFace stores its rectangle in 16 bits.
inline constexpr int max_image_side = 32767;

/// A pinhole camera relative to the model's origin. As in scene/camera.hpp, (cx, cy) is measured
/// from the top left corner of the image, and pixel centres lie at (column + 0.5, row + 0.5).
struct View {
  int width, height;  // at most max_image_side
  double fx, fy, cx, cy;
  double eye[3];
  double right[3], down[3], forward[3];  // unit axes of the image in world coordinates
  double near, far;
};

/// A triangle on the image. Edge functions are relative to the centre of the pixel (x0, y0), so
/// floats never hold large coordinates.
struct ProjectedFace {
  float dx[3], dy[3], c[3];
  std::int16_t x0, y0, x1, y1;  // bounds of the pixels: x0 <= x < x1, y0 <= y < y1

  TUREEN_HOST_DEVICE bool empty() const { return x0 >= x1; }
};

/// e_0, e_1, e_2 at (x, y) in pixel indices: (3, 5) is the centre of the pixel in column 3, row 5.
template <class Real>
TUREEN_HOST_DEVICE void edge_values(const ProjectedFace& face, Real x, Real y, Real (&e)[3]) {
  for (int k = 0; k < 3; ++k)
    e[k] = Real(face.c[k]) + Real(face.dx[k]) * (x - Real(face.x0)) +
           Real(face.dy[k]) * (y - Real(face.y0));
}

TUREEN_HOST_DEVICE void view_coordinates(const View& view, const float* position, double (&v)[3]) {
  const double d[3] = {position[0] - view.eye[0], position[1] - view.eye[1],
                       position[2] - view.eye[2]};
  v[0] = view.right[0] * d[0] + view.right[1] * d[1] + view.right[2] * d[2];
  v[1] = view.down[0] * d[0] + view.down[1] * d[1] + view.down[2] * d[2];
  v[2] = view.forward[0] * d[0] + view.forward[1] * d[1] + view.forward[2] * d[2];
}

/// Extends an interval of pixel indices to contain a coordinate, which must not be NaN. The clamp
/// makes the cast safe for all other values.
TUREEN_HOST_DEVICE void include(double coordinate, int size, int& low, int& high) {
  const double clamped = coordinate < -1 ? -1 : coordinate > size + 1 ? size + 1 : coordinate;
  // Pixel i has its centre at i + 1/2. `first` is the first centre not left of the coordinate;
  // `last` is one after the last centre not right of it.
  const int first = int(std::ceil(clamped - 0.5)), last = int(std::floor(clamped - 0.5)) + 1;
  low = first < low ? first : low;
  high = last > high ? last : high;
}

/// Sets the rectangle around the corners beyond the near plane and the points where edges cross
/// that plane.
TUREEN_HOST_DEVICE void bounding_rectangle(const View& view, const double (&v)[3][3],
                                           ProjectedFace& face) {
  int x0 = view.width, x1 = 0, y0 = view.height, y1 = 0;
  const auto corner = [&](double x, double y, double w) {
    include(view.fx * x / w + view.cx, view.width, x0, x1);
    include(view.fy * y / w + view.cy, view.height, y0, y1);
  };
  for (int i = 0; i < 3; ++i) {
    const double* a = v[i];
    const double* b = v[(i + 1) % 3];
    if (a[2] >= view.near) corner(a[0], a[1], a[2]);
    if ((a[2] >= view.near) != (b[2] >= view.near)) {
      const double t = (view.near - a[2]) / (b[2] - a[2]);
      corner(a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), view.near);
    }
  }
  face.x0 = std::int16_t(x0 > 0 ? x0 : 0);
  face.y0 = std::int16_t(y0 > 0 ? y0 : 0);
  face.x1 = std::int16_t(x1 < view.width ? x1 : view.width);
  face.y1 = std::int16_t(y1 < view.height ? y1 : view.height);
}

/// `corners`: three positions of three floats. The result is empty for triangles that are edge-on,
/// have no area, lie outside the image or have a coordinate that is not finite.
TUREEN_HOST_DEVICE ProjectedFace project(const View& view, const float* corners) {
  ProjectedFace face{};
  double v[3][3];
  for (int i = 0; i < 3; ++i) {
    view_coordinates(view, corners + 3 * i, v[i]);
    for (int j = 0; j < 3; ++j)
      if (!std::isfinite(v[i][j])) return face;
  }
  if (v[0][2] < view.near && v[1][2] < view.near && v[2][2] < view.near) return face;
  bounding_rectangle(view, v, face);
  if (face.x0 >= face.x1 || face.y0 >= face.y1) {
    face.x1 = face.x0;
    return face;
  }
  const double px = face.x0 + 0.5 - view.cx, py = face.y0 + 0.5 - view.cy;
  double p[3][3];
  for (int i = 0; i < 3; ++i) {
    p[i][0] = view.fx * v[i][0] - px * v[i][2];
    p[i][1] = view.fy * v[i][1] - py * v[i][2];
    p[i][2] = v[i][2];
  }
  double cross[3][3], determinant = 0;
  for (int k = 0; k < 3; ++k) {
    const double *a = p[(k + 1) % 3], *b = p[(k + 2) % 3];
    cross[k][0] = a[1] * b[2] - a[2] * b[1];
    cross[k][1] = a[2] * b[0] - a[0] * b[2];
    cross[k][2] = a[0] * b[1] - a[1] * b[0];
  }
  for (int j = 0; j < 3; ++j) determinant += p[0][j] * cross[0][j];
  const double inverse = 1 / determinant;
  bool finite = true;
  for (int k = 0; k < 3; ++k) {
    face.dx[k] = float(cross[k][0] * inverse);
    face.dy[k] = float(cross[k][1] * inverse);
    face.c[k] = float(cross[k][2] * inverse);
    finite = finite && std::isfinite(face.dx[k]) && std::isfinite(face.dy[k]) &&
             std::isfinite(face.c[k]);
  }
  if (!finite) face.x1 = face.x0;
  return face;
}

}  // namespace tureen::trainer::kernels
