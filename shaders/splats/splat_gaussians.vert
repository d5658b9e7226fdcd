// A Gaussian in the image as the smallest regular triangle around the circle, in standard
// deviations, outside of which alpha is below MIN_ALPHA.
#include "eye.glsl"
#include "splat_hidden.glsl"
#include "splat_kernel_texels.glsl"
#include "splat_measured_vertex.glsl"
#include "splat_order.glsl"
#include "splat_projected.glsl"

uniform sampler2D colors, places, axes_of_splats;
uniform vec2 half_size;   // of the image, in pixels
uniform vec2 depth_of_z;  // clip z of the view's z: depth_of_z.x * z + depth_of_z.y; clip w is -z

// Splats that reach farther than this, in pixels, are drawn as a triangle around the image: the
// rasteriser rounds coordinates far outside the image.
const float farthest = 8192.0;

out vec2 deviations;
flat out vec4 color;
#if AS_PUBLISHED
flat out vec4 tiles;
#include "splat_tiles.glsl"
#endif
#if MEASURES || OUTPUT == OUTPUT_SAMPLE
flat out float center_depth;
#endif

void main() {
  uint splat = ordered_splat();
  ivec2 at = projected_position(splat);
  vec4 center = texelFetch(places, at, 0);
  vec4 axes = texelFetch(axes_of_splats, at, 0);
  color = texelFetch(colors, at, 0);
#if MEASURES || OUTPUT == OUTPUT_SAMPLE
  center_depth = -center.z;
#endif
#if MEASURES
  // The axis of the smallest scale; of a disc, its normal.
  vec3 scales = kernel_texel(splat, 1).xyz;
  mat3 axes_in_layer = rotation_of(kernel_texel(splat, 2));
  int thinnest = scales.z <= min(scales.x, scales.y) ? 2 : scales.y <= scales.x ? 1 : 0;
  measure_vertex(axes_in_layer[thinnest], (kernel_texel(splat, 0).xyz - eye_high) - eye_low);
#endif
  const float root_3 = 1.7320508075688772;
  int corner = splat_corner();
  deviations = center.w * (corner == 0 ? vec2(-root_3, -1.0)
                          : corner == 1 ? vec2(root_3, -1.0) : vec2(0.0, 2.0));
  vec2 pixel = center.xy + deviations.x * axes.xy + deviations.y * axes.zw;
  float squared_1 = dot(axes.xy, axes.xy), squared_2 = dot(axes.zw, axes.zw);
#if AS_PUBLISHED
  float half_difference = 0.5 * (squared_1 - squared_2);
  float largest = 0.5 * (squared_1 + squared_2) + sqrt(max(0.1, half_difference * half_difference));
  // Their pixel 0 has its centre at 0.
  tiles = tiles_around(in_whole_image(center.xy) - 0.5, ceil(3.0 * sqrt(largest)));
#endif
  if (center.w * center.w * max(squared_1, squared_2) > farthest * farthest) {
    pixel = 2.0 * half_size * vec2(corner == 1 ? 2.0 : 0.0, corner == 2 ? 2.0 : 0.0);
    vec2 from_center = pixel - center.xy;
    // The axes are orthogonal.
    deviations = vec2(dot(from_center, axes.xy) / squared_1, dot(from_center, axes.zw) / squared_2);
  }
  // Beside the eye, large splats often miss the image: every pixel would be shaded for nothing. A
  // thousandth and a pixel more, for rounding.
  vec2 reach = 1.001 * center.w * sqrt(axes.xy * axes.xy + axes.zw * axes.zw) + 1.0;
  bool is_drawn =
      center.w > 0.0 && all(lessThanEqual(abs(center.xy - half_size), half_size + reach)) &&
                  !is_hidden(center.xy - reach, center.xy + reach, half_size);
  gl_Position = is_drawn ? vec4(pixel / half_size - 1.0,
                                (depth_of_z.x * center.z + depth_of_z.y) / -center.z, 1.0)
                         : nowhere;
  if (is_drawn) gl_Position = at_center_depth(gl_Position, -center.z, splat);
}
