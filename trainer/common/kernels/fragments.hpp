// The fragment of a triangle at a pixel.
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

/// For kernels with one thread per pixel. On the processor, draw_tile()
/// (trainer/diffsoup/cpu/visibility_kernels.hpp) has the same arithmetic. Returns false if the
/// triangle does not cover the pixel's centre between the near and the far plane.
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

}  // namespace tureen::trainer::kernels
