#include "trainer/diffsoup/cpu/batch_image.hpp"

#include <algorithm>

namespace tureen::trainer {

kernels::Rectangle BatchImage::tile(std::size_t index) const {
  const int x = int(index) % tiles_x * tile_side, y = int(index) / tiles_x * tile_side;
  return {x, y, std::min(x + tile_side, view.width), std::min(y + tile_side, view.height)};
}

kernels::View view_of(const Camera& camera, glm::dvec3 origin, double near, double far) {
  kernels::View view{};
  view.width = camera.width;
  view.height = camera.height;
  view.fx = camera.fx;
  view.fy = camera.fy;
  view.cx = camera.cx;
  view.cy = camera.cy;
  view.near = near;
  view.far = far;
  const glm::dvec3 eye = camera.eye() - origin;
  const glm::dmat3 axes = camera.world_from_view_rotation();  // right, up, backward
  for (int i = 0; i < 3; ++i) {
    view.eye[i] = eye[i];
    view.right[i] = axes[0][i];
    view.down[i] = -axes[1][i];
    view.forward[i] = -axes[2][i];
  }
  return view;
}

}  // namespace tureen::trainer
