// Triangles that cover a splat in the image.
#include "splat_hidden.glsl"
#include "splat_order.glsl"

// The range of one image coordinate of the quadric {H x + H_c : |x| <= 1}, relative to the centre.
// `along` are the coordinates of H's columns and `w` their depths; `center_w` is the depth of the
// centre, and the quadric lies in front of the eye.
vec2 range_of(vec3 along, vec3 w, float center_w) {
  // Relative to the depth: fourth powers of lengths overflow beyond 1e9 (docs/numerics.md, E8).
  along /= center_w;
  w /= center_w;
  float a = dot(w, w) - 1.0;  // < 0
  float b = dot(along, w);
  float root = sqrt(max(b * b - a * dot(along, along), 0.0));
  return vec2(b + root, b - root) / a;
}

// The position of a corner of a right-angled triangle around the rectangle, in pixels; or `nowhere`.
vec4 corner_around(vec2 low, vec2 high, int corner, vec2 half_size) {
  if (is_hidden(low, high, half_size)) return nowhere;
  vec2 size = 2.0 * (high - low);
  vec2 pixel = low + vec2(corner == 1 ? size.x : 0.0, corner == 2 ? size.y : 0.0);
  return vec4(pixel / half_size - 1.0, 0.0, 1.0);
}
