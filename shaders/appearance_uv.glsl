// Conventional textures: a material is a rectangle of texels within one linear store, sampled in
// the shader, so that drivers' filtering does not differ from the oracle's.
#include "texel_store.glsl"

uniform sampler2DArray texels0;  // colour, or the first four features
#if LATENT_FEATURES
uniform sampler2DArray texels1;  // the last four features
#endif
#if COLOR_MLP
vec3 color_mlp(vec4 features0, vec4 features1, vec3 to_eye);
#endif
uniform sampler2DArray coordinates;  // (u, v) of a corner, three texels a face
#if VERTEX_TINT
uniform sampler2DArray tints;  // RGBA of a corner, three texels a face
#endif
uniform usampler2DArray material_of_face;
// Three texels a material, see runtime/passes/appearance_source.cpp:
//   (first texel, width, height, flags), factor as float bits, (mask threshold as float bits, 0, 0, 0)
uniform usampler2DArray materials;

const uint flag_has_image = 1u;
const uint flag_linear = 2u;
const uint shift_wrap_u = 2u;
const uint shift_wrap_v = 4u;
const uint shift_mask_channel = 6u;
const uint wrap_repeat = 0u;
const uint wrap_mirror = 1u;

struct Material {
  uvec4 image;  // first texel, width, height, flags
  vec4 factor;
  float mask_threshold;
};

Material material_of(uint face) {
  uint index = texelFetch(material_of_face, texel_position(face), 0).r;
  Material material;
  material.image = texelFetch(materials, texel_position(3u * index), 0);
  material.factor = uintBitsToFloat(texelFetch(materials, texel_position(3u * index + 1u), 0));
  material.mask_threshold =
      uintBitsToFloat(texelFetch(materials, texel_position(3u * index + 2u), 0).x);
  return material;
}

// % is undefined in GLSL for negative operands, and unreliable on llvmpipe.
int modulo(int i, int n) {
  int remainder = abs(i) % n;
  return i < 0 && remainder > 0 ? n - remainder : remainder;
}

int wrapped(int i, int size, uint mode) {
  if (mode == wrap_repeat) return modulo(i, size);
  if (mode == wrap_mirror) {
    int period = 2 * size;
    int j = modulo(i, period);
    return j < size ? j : period - 1 - j;
  }
  return clamp(i, 0, size - 1);
}

vec4 texel_at(sampler2DArray store, uvec4 image, ivec2 at) {
  int x = wrapped(at.x, int(image.y), (image.w >> shift_wrap_u) & 3u);
  int y = wrapped(at.y, int(image.z), (image.w >> shift_wrap_v) & 3u);
  return texelFetch(store, texel_position(image.x + uint(y) * image.y + uint(x)), 0);
}

vec4 image_sample(sampler2DArray store, uvec4 image, vec2 uv) {
  vec2 position = uv * vec2(image.yz);
  if ((image.w & flag_linear) == 0u) return texel_at(store, image, ivec2(floor(position)));
  position -= 0.5;
  ivec2 at = ivec2(floor(position));
  vec2 f = position - vec2(at);
  return mix(mix(texel_at(store, image, at), texel_at(store, image, at + ivec2(1, 0)), f.x),
             mix(texel_at(store, image, at + ivec2(0, 1)), texel_at(store, image, at + ivec2(1, 1)), f.x),
             f.y);
}

vec4 corner_mix(sampler2DArray store, uint face, vec2 b) {
  return b.x * texelFetch(store, texel_position(3u * face), 0) +
         b.y * texelFetch(store, texel_position(3u * face + 1u), 0) +
         (1.0 - b.x - b.y) * texelFetch(store, texel_position(3u * face + 2u), 0);
}

vec4 first_sample(Material material, uint face, vec2 b) {
#if COLOR_MLP
  return image_sample(texels0, material.image, corner_mix(coordinates, face, b).xy);
#else
  vec4 color = material.factor;
  if ((material.image.w & flag_has_image) != 0u)
    color *= image_sample(texels0, material.image, corner_mix(coordinates, face, b).xy);
#if VERTEX_TINT
  color *= corner_mix(tints, face, b);
#endif
  return color;
#endif
}

float mask_value(Material material, uint face, vec2 b) {
  vec4 value = first_sample(material, face, b);
  uint channel = (material.image.w >> shift_mask_channel) & 3u;
  return channel == 0u ? value.r : channel == 1u ? value.g : channel == 2u ? value.b : value.a;
}

bool fragment_exists(uint face, vec2 b) {
  Material material = material_of(face);
  return mask_value(material, face, b) >= material.mask_threshold;
}

vec3 fragment_color(uint face, vec2 b, vec3 to_eye) {
  Material material = material_of(face);
  vec4 first = first_sample(material, face, b);
#if !COLOR_MLP
  return min(first.rgb, 1.0);
#elif LATENT_FEATURES
  return color_mlp(first, image_sample(texels1, material.image, corner_mix(coordinates, face, b).xy),
                   to_eye);
#else
  return color_mlp(first, vec4(0.0), to_eye);
#endif
}
