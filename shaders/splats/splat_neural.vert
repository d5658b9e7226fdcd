// An ellipsoid as the triangle around the box of its image.
#include "eye.glsl"
#include "splat_cover.glsl"
#include "splat_kernel_texels.glsl"
#include "splat_measured_vertex.glsl"
#include "splat_projected.glsl"

uniform sampler2D colors;
uniform mat3 view_from_layer;  // rotation, perhaps a mirror
uniform vec2 focal;            // in pixels
uniform vec2 principal_point;  // in pixels from the lower left corner of the image
uniform vec2 half_size;        // of the image, in pixels
uniform float near;

flat out uint splat;
flat out vec3 color;

void main() {
  splat = ordered_splat();
  vec4 color_and_drawn = texelFetch(colors, projected_position(splat), 0);
  color = color_and_drawn.rgb;
  vec3 from_eye = (kernel_texel(splat, 0).xyz - eye_high) - eye_low;
#if MEASURES
  measure_vertex(vec3(0.0), from_eye);  // the fragments have normals of their own
#endif
  vec3 semi_axes = kernel_texel(splat, 1).xyz;
  // Lengths below are in this unit.
  float unit = power_of_two_below(max(semi_axes.x, max(semi_axes.y, semi_axes.z)));
  semi_axes /= unit;
  vec3 center = view_from_layer * (from_eye / unit);
  mat3 axes = view_from_layer * rotation_of(kernel_texel(splat, 2));
  float depth = -center.z;
  vec3 z = vec3(axes[0].z, axes[1].z, axes[2].z) * semi_axes;
  gl_Position = nowhere;
  if (!(color_and_drawn.a > 0.0 && depth + length(z) > near / unit)) return;
  // An ellipsoid that reaches the near plane may cover any pixel.
  vec2 low = vec2(0.0), high = 2.0 * half_size;
  if (depth - length(z) > near / unit) {
    vec2 slope = center.xy / depth;
    vec2 x = range_of(focal.x * (vec3(axes[0].x, axes[1].x, axes[2].x) * semi_axes + slope.x * z),
                      -z, depth);
    vec2 y = range_of(focal.y * (vec3(axes[0].y, axes[1].y, axes[2].y) * semi_axes + slope.y * z),
                      -z, depth);
    vec2 at = focal * slope + principal_point;
    // One pixel more, for rounding.
    low = at + vec2(x.x, y.x) - 1.0;
    high = at + vec2(x.y, y.y) + 1.0;
  }
  gl_Position = at_center_depth(corner_around(low, high, splat_corner(), half_size), unit * depth, splat);
}
