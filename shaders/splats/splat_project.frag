// The values that all pixels of a splat share, computed once a splat and frame: one texel of each target a
// splat, or one a corner if the corners have their own colours.
#include "eye.glsl"
#include "harmonics_color.glsl"
#include "splat_kernel_texels.glsl"

uniform int projected_count;
uniform float color_unit;  // the result for colour 1
uniform mat3 view_from_layer;  // rotation, perhaps a mirror

layout(location = 0) out vec4 color;  // rgb from 0 to 65504 times color_unit, and opacity

// SplatProfile::min_center_depth
bool is_center_drawn(float depth) { return MIN_CENTER_DEPTH == 0.0 || depth > MIN_CENTER_DEPTH; }

// The opacity; 0 if the splat is not drawn.
#include "splat_project_kernel.glsl"

vec3 color_of(uint element, vec3 from_eye) {
  vec3 sum = harmonics_color(element, direction_of(from_eye));
  // The largest half float: in targets of halves, larger ones would become infinite, and 0 times
  // them NaN (docs/numerics.md, E7). The comparison is false for NaN.
  return mix(vec3(0.0), min(sum, 65504.0), greaterThan(sum, vec3(0.0)));
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  int element = texel.y * PROJECTED_COLUMNS + texel.x;
  if (element >= projected_count) discard;
  vec3 from_eye;
  float opacity = project(uint(element), from_eye);
  color = vec4(color_unit * color_of(uint(element), from_eye), opacity);
}
