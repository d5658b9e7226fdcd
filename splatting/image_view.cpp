#include "splatting/image_view.hpp"

#include <glm/mat3x3.hpp>

namespace tureen::splatting {

ImageView image_view(const Camera& camera, const glm::dvec3& eye, double near,
                     const SplatProfile& profile, const Camera& whole) {
  ImageView view{};
  const glm::dmat3 rotation(camera.view_from_world);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      // OpenGL's y points up and its z backwards.
      view.view_from_layer[3 * row + column] =
          static_cast<float>(row == 0 ? rotation[column][row] : -rotation[column][row]);
  for (int i = 0; i < 3; ++i) {
    view.eye_high[i] = static_cast<float>(eye[i]);
    view.eye_low[i] = static_cast<float>(eye[i] - double(view.eye_high[i]));
  }
  view.fx = static_cast<float>(camera.fx);
  view.fy = static_cast<float>(camera.fy);
  view.cx = static_cast<float>(camera.cx);
  view.cy = static_cast<float>(camera.cy);
  const double margin_x = ewa_margin * whole.width, margin_y = ewa_margin * whole.height;
  view.slope_low[0] = static_cast<float>((-whole.cx - margin_x) / whole.fx);
  view.slope_low[1] = static_cast<float>((-whole.cy - margin_y) / whole.fy);
  view.slope_high[0] = static_cast<float>((whole.width - whole.cx + margin_x) / whole.fx);
  view.slope_high[1] = static_cast<float>((whole.height - whole.cy + margin_y) / whole.fy);
  view.near = static_cast<float>(near);
  view.min_center_depth = profile.min_center_depth;
  const bool dilates = profile.low_pass == SplatProfile::LowPass::dilation ||
                       profile.low_pass == SplatProfile::LowPass::mip;
  view.dilation = dilates ? static_cast<float>(dilation_variance) : 0.0f;
  view.keep_integral = profile.low_pass == SplatProfile::LowPass::mip;
  if (profile.low_pass == SplatProfile::LowPass::screen)
    view.screen_variance = static_cast<float>(tureen::screen_variance);
  view.min_alpha = profile.min_alpha;
  view.max_alpha = profile.max_alpha;
  view.stop_transmittance = profile.stop_transmittance;
  view.width = camera.width;
  view.height = camera.height;
  return view;
}

}  // namespace tureen::splatting
