// The values that all pixels of a splat share, computed once a splat and frame: one texel of each target a
// splat, or one a corner if the corners have their own colours.
#include "eye.glsl"
#include "harmonics.glsl"
#include "splat_kernel_texels.glsl"

uniform sampler2DArray coefficients;  // HARMONICS_COUNT texels a splat or corner
uniform int projected_count;
uniform mat3 view_from_layer;  // rotation, perhaps a mirror

layout(location = 0) out vec4 color;  // rgb >= 0, and opacity

// SplatProfile::min_center_depth
bool is_center_drawn(float depth) { return MIN_CENTER_DEPTH == 0.0 || depth > MIN_CENTER_DEPTH; }

// The opacity; 0 if the splat is not drawn.
#include "splat_project_kernel.glsl"

vec3 color_of(uint element, vec3 from_eye) {
  float distance = length(from_eye);
  // At the eye the direction is undefined; any finite one is valid (docs/numerics.md, V5).
  vec3 d = distance > 0.0 ? from_eye / distance : vec3(0.0, 0.0, 1.0);
  float basis[HARMONICS_COUNT];
  harmonics_basis(d, basis);
  vec3 sum = vec3(0.5);
  for (int i = 0; i < HARMONICS_COUNT; ++i)
    sum += basis[i] *
           texelFetch(coefficients, texel_position(element * uint(HARMONICS_COUNT) + uint(i)), 0).rgb;
  return max(sum, 0.0);
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  int element = texel.y * PROJECTED_COLUMNS + texel.x;
  if (element >= projected_count) discard;
  vec3 from_eye;
  float opacity = project(uint(element), from_eye);
  color = vec4(color_of(uint(element), from_eye), opacity);
}
