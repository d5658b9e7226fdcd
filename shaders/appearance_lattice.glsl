// A lattice of seven features and alpha a face. LATTICE_LEVEL >= 0: every face has that level, and
// texels are stored in face order. -1: `patches` locates the texels of each face.
#include "lattice.glsl"
#include "texel_store.glsl"

uniform sampler2DArray features0;  // f0..f3
#if LATENT_FEATURES
uniform sampler2DArray features1;  // f4..f6
#endif
// Alpha at the four corners of each lattice cell: (x+1, y), (x, y+1), (x, y), (x+1, y+1). The cells
// of a face are ordered like the texels of a lattice with one row less. The alpha test needs one
// read.
#if ALPHA_BY_CELL
uniform sampler2DArray alpha_cells;
#else
uniform sampler2DArray alpha_texels;  // alpha of each texel: less memory, three reads
#endif
#if LATTICE_LEVEL < 0
uniform usampler2DArray patches;  // first texel, level, first cell
#endif

struct FacePatch {
  uint first_texel;
  int level;
  uint first_cell;
};

FacePatch patch_of(uint face) {
#if LATTICE_LEVEL >= 0
  const uint n = 1u << LATTICE_LEVEL;
  return FacePatch(face * ((n + 1u) * (n + 2u) / 2u), LATTICE_LEVEL, face * (n * (n + 1u) / 2u));
#else
  uvec4 entry = texelFetch(patches, texel_position(face), 0);
  return FacePatch(entry.x, int(entry.y), entry.z);
#endif
}

float fragment_alpha(uint face, vec2 b) {
  FacePatch at = patch_of(face);
#if ALPHA_BY_CELL
  LatticeCell cell = lattice_cell(at.level, b);
  uint index = at.first_cell + lattice_texel_index(cell.x, cell.y);
  vec4 alpha = texelFetch(alpha_cells, texel_position(index), 0);
  bool upper;
  vec3 weights = lattice_weights(cell.p, upper);
  float third = upper ? alpha.w : alpha.z;
#else
  LatticeFootprint footprint = lattice_footprint(at.level, b);
  uvec3 texels = at.first_texel + footprint.texels;
  vec3 weights = footprint.weights;
  vec2 alpha = vec2(texelFetch(alpha_texels, texel_position(texels.x), 0).r,
                    texelFetch(alpha_texels, texel_position(texels.y), 0).r);
  float third = texelFetch(alpha_texels, texel_position(texels.z), 0).r;
#endif
  // This form reproduces constants exactly: a constant alpha of 1/2 has no holes.
  return third + weights.x * (alpha.x - third) + weights.y * (alpha.y - third);
}

bool fragment_exists(uint face, vec2 b) { return fragment_alpha(face, b) >= ALPHA_THRESHOLD; }

vec4 lattice_sample(sampler2DArray store, LatticeFootprint at) {
  return at.weights.x * texelFetch(store, texel_position(at.texels.x), 0) +
         at.weights.y * texelFetch(store, texel_position(at.texels.y), 0) +
         at.weights.z * texelFetch(store, texel_position(at.texels.z), 0);
}

#if COLOR_MLP
vec3 color_mlp(vec4 features0, vec4 features1, vec3 to_eye);
#endif

LatticeFootprint footprint_on(uint face, vec2 b) {
  FacePatch of_face = patch_of(face);
  LatticeFootprint at = lattice_footprint(of_face.level, b);
  at.texels += of_face.first_texel;
  return at;
}

vec3 fragment_color(uint face, vec2 b, vec3 to_eye) {
  LatticeFootprint at = footprint_on(face, b);
#if !COLOR_MLP
  return lattice_sample(features0, at).rgb;
#elif LATENT_FEATURES
  return color_mlp(lattice_sample(features0, at), lattice_sample(features1, at), to_eye);
#else
  return color_mlp(lattice_sample(features0, at), vec4(0.0), to_eye);
#endif
}
