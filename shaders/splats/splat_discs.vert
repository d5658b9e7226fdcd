// A disc as the triangle around the box of its image, and around the disc of the screen's low pass.
#include "eye.glsl"
#include "splat_cover.glsl"
#include "splat_kernel_texels.glsl"
#include "splat_measured_vertex.glsl"
#include "splat_projected.glsl"

uniform sampler2D colors, planes_xy, planes_w, places;
uniform vec2 half_size;  // of the image, in pixels
uniform float near;
uniform float pixel_area;  // in samples

flat out vec4 color;
flat out vec4 plane_xy;
flat out vec3 plane_w;
flat out vec4 origin;  // splat_project_discs.glsl: place
#if AS_PUBLISHED
flat out vec4 tiles;
#include "splat_tiles.glsl"

// Around the box of three standard deviations, which also holds the filter's disc (2DGS). The
// published code uses the same formula for a disc that reaches the eye's plane.
vec4 published_tiles() {
  float d = 9.0 * dot(plane_w.xy, plane_w.xy) - plane_w.z * plane_w.z;
  vec2 x = plane_xy.xy, y = plane_xy.zw;
  vec2 middle = 9.0 / d * vec2(dot(x, plane_w.xy), dot(y, plane_w.xy));
  vec2 squared = middle * middle - 9.0 / d * vec2(dot(x, x), dot(y, y));
  vec2 extent = sqrt(max(squared, 1e-4));
  float radius = max(max(extent.x, extent.y), 3.0 * 0.7071067811865476);
  return tiles_around(in_whole_image(origin.xy + middle), ceil(radius));
}
#endif

void main() {
  uint splat = ordered_splat();
  ivec2 at = projected_position(splat);
  color = texelFetch(colors, at, 0);
  plane_xy = texelFetch(planes_xy, at, 0);
  vec4 plane_w_and_drawn = texelFetch(planes_w, at, 0);
  plane_w = plane_w_and_drawn.xyz;
  origin = texelFetch(places, at, 0);
#if AS_PUBLISHED
  tiles = published_tiles();
#endif
#if MEASURES
  measure_vertex(rotation_of(kernel_texel(splat, 2))[2],
                 (kernel_texel(splat, 0).xyz - eye_high) - eye_low);
#endif
  float excess = 2.0 * log(color.a / MIN_ALPHA);
  gl_Position = nowhere;
  if (!(plane_w_and_drawn.w > 0.0 && excess > 0.0)) return;
  float radius = sqrt(excess);
  vec3 w = vec3(radius * plane_w.xy, 0.0);
  if (!(plane_w.z + length(w) > near)) return;
  // A disc that reaches the near plane may cover any pixel.
  vec2 low = vec2(0.0), high = 2.0 * half_size;
  if (plane_w.z - length(w) > near) {
    vec2 x = range_of(vec3(radius * plane_xy.xy, 0.0), w, plane_w.z);
    vec2 y = range_of(vec3(radius * plane_xy.zw, 0.0), w, plane_w.z);
    // One pixel more, for rounding.
    vec2 margin = vec2(1.0);
#if SCREEN_FILTER
    float screen = radius * sqrt(SCREEN_VARIANCE * pixel_area) + 1.0;
    low = origin.xy + min(vec2(x.x, y.x) - margin, -screen);
    high = origin.xy + max(vec2(x.y, y.y) + margin, screen);
#else
    low = origin.xy + vec2(x.x, y.x) - margin;
    high = origin.xy + vec2(x.y, y.y) + margin;
#endif
  }
  gl_Position = at_center_depth(corner_around(low, high, splat_corner(), half_size), plane_w.z, splat);
}
