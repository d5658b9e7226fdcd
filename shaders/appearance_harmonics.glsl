// Colour 1/2 + sum_i Y_i(d) c_i, clamped to [0, 1], of a face (HARMONICS_PER_VERTEX 0: d at the centroid) or of
// each corner, interpolated (1). VIEW_SIGN is +1 for surface-to-eye coefficients, -1 for
// eye-to-surface ones.
#include "eye.glsl"
#include "harmonics_color.glsl"

uniform sampler2DArray anchors;       // the point of an element from which d points to the eye

vec3 element_color(uint element) {
  vec3 anchor = texelFetch(anchors, texel_position(element), 0).xyz;
  vec3 to_eye = -((anchor - eye_high) - eye_low);
  return clamp(harmonics_color(element, direction_of(VIEW_SIGN * to_eye)), 0.0, 1.0);
}

bool fragment_exists(uint face, vec2 b) { return true; }

float alpha_margin(uint face, vec2 b) { return 1.0; }

vec3 fragment_color(uint face, vec2 b, vec3 to_eye) {
#if HARMONICS_PER_VERTEX
  return b.x * element_color(3u * face) + b.y * element_color(3u * face + 1u) +
         (1.0 - b.x - b.y) * element_color(3u * face + 2u);
#else
  return element_color(face);
#endif
}
