// A disc's plane in the image (2DGS): a point (u, v) of the disc, in standard deviations, has the
// homogeneous image point u * H_u + v * H_v + H_c, in pixels from an origin. If the centre is in
// front of the near plane, the origin is its image; then H_c = (0, 0, depth).
uniform vec2 focal;            // in pixels
uniform vec2 principal_point;  // in pixels from the lower left corner of the image
uniform float near;

layout(location = 1) out vec4 plane_xy;  // x of H_u and H_v, then their y
layout(location = 2) out vec4 plane_w;   // w of H_u, H_v and H_c, and 1 if the splat is drawn
layout(location = 3) out vec4 place;     // the origin in pixels from the lower left corner; H_c.xy

float project(uint splat, out vec3 from_eye) {
  vec4 texel = kernel_texel(splat, 0);
  from_eye = (texel.xyz - eye_high) - eye_low;
  vec3 center = view_from_layer * from_eye;
  float depth = -center.z;
  plane_xy = vec4(0.0);
  plane_w = vec4(0.0);
  place = vec4(0.0);
  if (!is_center_drawn(depth)) return 0.0;
  bool in_front = depth > near;
#if SCREEN_FILTER
  if (!in_front) return 0.0;
#endif
  mat3 rotation = view_from_layer * rotation_of(kernel_texel(splat, 2));
  vec2 scales = kernel_texel(splat, 1).xy;
  vec2 slope = in_front ? center.xy / depth : vec2(0.0);
  vec3 u = scales.x * rotation[0], v = scales.y * rotation[1];
  plane_xy = vec4(focal.x * vec2(u.x + slope.x * u.z, v.x + slope.x * v.z),
                  focal.y * vec2(u.y + slope.y * u.z, v.y + slope.y * v.z));
  plane_w = vec4(-u.z, -v.z, depth, 1.0);
  place = vec4(focal * slope + principal_point,
               in_front ? vec2(0.0) : focal * center.xy);
  return texel.w;
}
