// Debug view values of appearances without texels.
float debug_view_alpha(uint face, vec2 b) { return alpha_margin(face, b) + ALPHA_THRESHOLD; }

float debug_view_threshold(uint face) { return ALPHA_THRESHOLD; }

void debug_view_features(uint face, vec2 b, out vec4 first, out vec4 second) {
  first = vec4(0.0);
  second = vec4(0.0);
}

vec3 debug_view_texel(uint face, vec2 b) { return vec3(0.0); }
