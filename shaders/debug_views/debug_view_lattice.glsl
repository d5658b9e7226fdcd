// Debug view values of lattices.
#include "texel_cell.glsl"

float debug_view_alpha(uint face, vec2 b) { return fragment_alpha(face, b); }

float debug_view_threshold(uint face) { return ALPHA_THRESHOLD; }

void debug_view_features(uint face, vec2 b, out vec4 first, out vec4 second) {
  LatticeFootprint at = footprint_on(face, b);
  first = lattice_sample(features0, at);
  second = lattice_sample(features1, at);
}

// The texel with the largest weight, features 0..2. Its neighbours in the lattice are at (1, 0),
// (0, 1), (-1, 1) and their opposites: each has another x - y modulo 3.
vec3 debug_view_texel(uint face, vec2 b) {
  FacePatch of_face = patch_of(face);
  LatticeCell cell = lattice_cell(of_face.level, b);
  bool upper;
  vec3 weights = lattice_weights(cell.p, upper);
  ivec2 at = ivec2(cell.x, cell.y);
  if (weights.x >= weights.y && weights.x >= weights.z)
    at.x += 1;
  else if (weights.y >= weights.z)
    at.y += 1;
  else if (upper)
    at += 1;
  // On the last diagonal the fourth corner lies outside the lattice: the border texel replaces it.
  at.y = min(at.y, (1 << of_face.level) - at.x);
  uint texel = of_face.first_texel + lattice_texel_index(at.x, at.y);
  // 384 is a multiple of 3, and no lattice has more than 128 rows.
  return cell_color(texelFetch(features0, texel_position(texel), 0).rgb, (at.x - at.y + 384) % 3);
}
