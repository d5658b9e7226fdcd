// A lattice of seven features and alpha a face. LATTICE_LEVEL >= 0 means that every face has that
// level and its texels follow each other in face order; -1 means that `patches` says where.
#include "lattice.glsl"
#include "texel_store.glsl"

uniform sampler2DArray features0;  // f0..f3
uniform sampler2DArray features1;  // f4..f6
uniform sampler2DArray alphas;     // alpha alone, so that cut-outs read nothing else
#if LATTICE_LEVEL < 0
uniform usampler2DArray patches;  // first texel, level
#endif

LatticeFootprint face_footprint(uint face, vec2 b) {
#if LATTICE_LEVEL >= 0
  const uint n = 1u << LATTICE_LEVEL;
  uint first = face * ((n + 1u) * (n + 2u) / 2u);
  LatticeFootprint at = lattice_footprint(LATTICE_LEVEL, b);
#else
  uvec2 patch_of_face = texelFetch(patches, texel_position(face), 0).xy;
  uint first = patch_of_face.x;
  LatticeFootprint at = lattice_footprint(int(patch_of_face.y), b);
#endif
  at.texels += first;
  return at;
}

vec4 lattice_sample(sampler2DArray store, LatticeFootprint at) {
  return at.weights.x * texelFetch(store, texel_position(at.texels.x), 0) +
         at.weights.y * texelFetch(store, texel_position(at.texels.y), 0) +
         at.weights.z * texelFetch(store, texel_position(at.texels.z), 0);
}

bool fragment_exists(uint face, vec2 b) {
  return lattice_sample(alphas, face_footprint(face, b)).r >= ALPHA_THRESHOLD;
}

#if COLOR_MLP
vec3 color_mlp(vec4 features0, vec4 features1, vec3 to_eye);
#endif

vec3 fragment_color(uint face, vec2 b, vec3 to_eye) {
  LatticeFootprint at = face_footprint(face, b);
  vec4 f = lattice_sample(features0, at);
#if COLOR_MLP
  return color_mlp(f, lattice_sample(features1, at), to_eye);
#else
  return f.rgb;
#endif
}
