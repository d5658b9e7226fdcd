// All pixels that a triangle covers within a rectangle, for a visitor. Visibility, gradients and
// blending thus use the same fragments.
#pragma once

#include "trainer/common/kernels/host_device.hpp"
#include "trainer/common/kernels/projection.hpp"

namespace tureen::trainer::kernels {

/// Half-open, in pixels.
struct Rectangle {
  int x0, y0, x1, y1;
};

struct Fragment {
  int x, y;
  float b0, b1;  // perspective-correct barycentrics of corners 0 and 1
  float inverse_depth;
};

/// The fragment of one pixel, for kernels with one thread per pixel. The arithmetic is the same as
/// below. Returns false if the triangle does not cover the pixel's centre between the near and the
/// far plane.
TUREEN_HOST_DEVICE bool fragment_at(const View& view, const ProjectedFace& face, int x, int y,
                                    Fragment& fragment) {
  float e[3];
  const float dx = float(x - face.x0), dy = float(y - face.y0);
  for (int k = 0; k < 3; ++k) {
    const float row = face.c[k] + face.dy[k] * dy;
    e[k] = row + face.dx[k] * dx;
  }
  const float inverse = e[0] + e[1] + e[2];
  if (!(e[0] >= 0 && e[1] >= 0 && e[2] >= 0)) return false;
  if (!(inverse >= float(1 / view.far) && inverse <= float(1 / view.near))) return false;
  fragment = {x, y, e[0] / inverse, e[1] / inverse, inverse};
  return true;
}

/// Calls visit(Fragment) row by row. Pixels whose centre lies on an edge belong to the triangle.
/// `view` supplies the near and the far plane.
template <class Visitor>
TUREEN_HOST_DEVICE void for_each_fragment(const View& view, const ProjectedFace& face,
                                          const Rectangle& within, Visitor&& visit) {
  const int x0 = face.x0 > within.x0 ? face.x0 : within.x0;
  const int x1 = face.x1 < within.x1 ? face.x1 : within.x1;
  const int y0 = face.y0 > within.y0 ? face.y0 : within.y0;
  const int y1 = face.y1 < within.y1 ? face.y1 : within.y1;
  const float nearest = float(1 / view.near), farthest = float(1 / view.far);
  constexpr int lanes = 8;
  for (int y = y0; y < y1; ++y) {
    float row[3];
    for (int k = 0; k < 3; ++k) row[k] = face.c[k] + face.dy[k] * float(y - face.y0);
    for (int begin = x0; begin < x1; begin += lanes) {
      float e0[lanes], e1[lanes], inverse[lanes], least[lanes];
      for (int l = 0; l < lanes; ++l) {
        const float dx = float(begin - face.x0 + l);
        e0[l] = row[0] + face.dx[0] * dx;
        e1[l] = row[1] + face.dx[1] * dx;
        const float e2 = row[2] + face.dx[2] * dx;
        inverse[l] = e0[l] + e1[l] + e2;
        const float smaller = e0[l] < e1[l] ? e0[l] : e1[l];
        least[l] = smaller < e2 ? smaller : e2;
      }
      const int count = x1 - begin < lanes ? x1 - begin : lanes;
      for (int l = 0; l < count; ++l)
        if (least[l] >= 0 && inverse[l] >= farthest && inverse[l] <= nearest)
          visit(Fragment{begin + l, y, e0[l] / inverse[l], e1[l] / inverse[l], inverse[l]});
    }
  }
}

}  // namespace tureen::trainer::kernels
