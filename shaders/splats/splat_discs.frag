// Alpha of a disc where the pixel's ray meets its plane.
flat in vec4 color;
flat in vec4 plane_xy;
flat in vec3 plane_w;
flat in vec4 origin;
#if MEASURES
flat in vec3 normal;
#endif

uniform float near;
uniform float pixel_area;  // in samples
#if AS_PUBLISHED
flat in vec4 tiles;
#include "splat_tiles.glsl"
#endif

#include "splat_depth_behind.glsl"
#include "splat_blended.glsl"

void main() {
#if AS_PUBLISHED
  if (!is_in_tiles(tiles, gl_FragCoord.xy)) {
    blend_nothing();
    return;
  }
#endif
  vec2 pixel = gl_FragCoord.xy - origin.xy;
  // (u, v, 1) is orthogonal to both.
  vec3 k = vec3(plane_xy.xy - pixel.x * plane_w.xy, origin.z - pixel.x * plane_w.z);
  vec3 l = vec3(plane_xy.zw - pixel.y * plane_w.xy, origin.w - pixel.y * plane_w.z);
  vec3 point = cross(k, l);
  vec2 uv = point.xy / point.z;
  float depth = plane_w.z + dot(uv, plane_w.xy);
  float squared = dot(uv, uv);
  // False for a plane that contains the ray.
  if (!(depth > near && squared < infinity)) squared = infinity;
#if SCREEN_FILTER
  float on_screen = dot(pixel, pixel) / (SCREEN_VARIANCE * pixel_area);
  if (on_screen < squared) {
    squared = on_screen;
    depth = plane_w.z;
  }
#endif
  float alpha = color.a * exp(-0.5 * squared);
  if (!(depth < depth_behind())) alpha = 0.0;
  WRITE_SPLAT(color.rgb, alpha, depth, normal, color.a, 0.0);
}
