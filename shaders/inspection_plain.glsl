// What appearances without texels have to show.
float inspected_alpha(uint face, vec2 b) { return alpha_margin(face, b) + ALPHA_THRESHOLD; }

float inspected_threshold(uint face) { return ALPHA_THRESHOLD; }

void inspected_features(uint face, vec2 b, out vec4 first, out vec4 second) {
  first = vec4(0.0);
  second = vec4(0.0);
}

vec3 inspected_texel(uint face, vec2 b) { return vec3(0.0); }
