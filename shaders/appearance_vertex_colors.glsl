// One colour a corner, interpolated.
#include "texel_store.glsl"

uniform sampler2DArray colors;  // three texels a face

vec4 interpolated_color(uint face, vec2 b) {
  // This form reproduces constants exactly: a constant alpha of 1/2 has no holes.
  vec4 third = texelFetch(colors, texel_position(3u * face + 2u), 0);
  return third + b.x * (texelFetch(colors, texel_position(3u * face), 0) - third) +
         b.y * (texelFetch(colors, texel_position(3u * face + 1u), 0) - third);
}

bool fragment_exists(uint face, vec2 b) { return interpolated_color(face, b).a >= ALPHA_THRESHOLD; }

float alpha_margin(uint face, vec2 b) { return interpolated_color(face, b).a - ALPHA_THRESHOLD; }

vec3 fragment_color(uint face, vec2 b, vec3 to_eye) { return interpolated_color(face, b).rgb; }
