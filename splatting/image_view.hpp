// A camera as single-precision constants of the kernels. Image coordinates are in pixels from the
// top left corner, to the right and down. View coordinates have their z along the viewing axis: x
// right, y down, z forward.
#pragma once

#include "scene/camera.hpp"
#include "scene/splats.hpp"

namespace tureen::splatting {

struct ImageView {
  float view_from_layer[9];           // rotation, row by row
  float eye_high[3], eye_low[3];      // their sum is the eye: differences from it keep their digits
  float fx, fy, cx, cy;               // in pixels
  float slope_low[2], slope_high[2];  // range of x/z and y/z in EWA's Jacobian
  float near;
  float min_center_depth;  // splats with a centre at or before this depth are not drawn
  float dilation;          // variance in px^2 along both axes; 0: none
  bool keep_integral;      // opacity compensates the dilation (Mip-Splatting)
  float screen_variance;   // of the low pass of 2DGS, in px^2; 0: none
  float min_alpha, max_alpha, stop_transmittance;
  float
      solidity;  // of triangle windows, 0..1 (SolidRamp in splatting/windows/window_plane-inl.hpp)
  int width, height;
};

/// The profile's constants, and solidity 0. `camera` and `eye` are in layer coordinates
/// (FrameCamera in runtime/passes/pass.hpp): the camera's rotation may contain a reflection, and
/// its translation is not used. `near` > 0 is in layer units. `whole` is the camera of the whole
/// image, for images drawn in tiles.
ImageView image_view(const Camera& camera, const glm::dvec3& eye, double near,
                     const SplatProfile& profile, const Camera& whole);

}  // namespace tureen::splatting
