// One colour a face.
#include "texel_store.glsl"

uniform sampler2DArray colors;  // one texel a face

bool fragment_exists(uint face, vec2 b) {
  return texelFetch(colors, texel_position(face), 0).a >= ALPHA_THRESHOLD;
}

float alpha_margin(uint face, vec2 b) {
  return texelFetch(colors, texel_position(face), 0).a - ALPHA_THRESHOLD;
}

vec3 fragment_color(uint face, vec2 b, vec3 to_eye) {
  return texelFetch(colors, texel_position(face), 0).rgb;
}
