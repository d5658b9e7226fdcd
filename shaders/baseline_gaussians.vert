// The plain baseline for Gaussians: a quad along the axes of the ellipse in the image (EWA
// splatting), which ends at sqrt(8) standard deviations.
#include "baseline_splats_quad.glsl"

uniform vec4 slope_range;  // the smallest x/depth and y/depth of the Jacobian, then the largest
uniform float dilation;    // added to the variances, in pixels^2

out vec2 deviations;
flat out vec4 color;

void main() {
  vec4 first = stored(0), second = stored(1), third = stored(2);
  vec3 from_eye = (first.xyz - eye_high) - eye_low;
  vec3 center = view_from_layer * from_eye;
  float depth = -center.z;
  if (!(depth > near && depth > min_center_depth)) {
    gl_Position = nowhere;
    return;
  }
  mat3 covariance = mat3(first.w, second.x, second.y, second.x, second.z, second.w, second.y,
                         second.w, third.x);
  vec2 slope = clamp(center.xy / depth, slope_range.xy, slope_range.zw);
  // Rows of the Jacobian times view_from_layer.
  vec3 x = transpose(view_from_layer) * vec3(focal.x, 0.0, focal.x * slope.x) / depth;
  vec3 y = transpose(view_from_layer) * vec3(0.0, focal.y, focal.y * slope.y) / depth;
  float xx = dot(x, covariance * x), xy = dot(x, covariance * y), yy = dot(y, covariance * y);
  float opacity = third.y;
#if KEEP_INTEGRAL
  float before = xx * yy - xy * xy;
#endif
  xx += dilation;
  yy += dilation;
#if KEEP_INTEGRAL
  opacity *= sqrt(max(before, 0.0) / (xx * yy - xy * xy));
#endif
  float middle = 0.5 * (xx + yy), root = length(vec2(0.5 * (xx - yy), xy));
  float larger = middle + root, smaller = max(middle - root, 0.0);
  vec2 direction = xy != 0.0 ? normalize(vec2(xy, larger - xx))
                   : xx > yy ? vec2(1.0, 0.0) : vec2(0.0, 1.0);
  deviations = sqrt(8.0) * (2.0 * quad_corner() - 1.0);
  color = vec4(color_towards(from_eye), opacity);
  vec2 pixel = focal * center.xy / depth + principal_point +
               deviations.x * sqrt(larger) * direction +
               deviations.y * sqrt(smaller) * vec2(-direction.y, direction.x);
  gl_Position = at_pixel(pixel);
}
