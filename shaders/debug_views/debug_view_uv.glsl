// Debug view values of conventional textures.
#include "texel_cell.glsl"

float debug_view_alpha(uint face, vec2 b) { return mask_value(material_of(face), face, b); }

float debug_view_threshold(uint face) { return material_of(face).mask_threshold; }

void debug_view_features(uint face, vec2 b, out vec4 first, out vec4 second) {
#if COLOR_MLP
  Material material = material_of(face);
  vec2 uv = corner_mix(coordinates, face, b).xy;
  first = image_sample(texels0, material.image, uv);
  second = image_sample(texels1, material.image, uv);
#else
  first = vec4(0.0);
  second = vec4(0.0);
#endif
}

// The stored texel at the point, or the factor of a material without an image.
vec3 debug_view_texel(uint face, vec2 b) {
  Material material = material_of(face);
  if ((material.image.w & flag_has_image) == 0u) return min(material.factor.rgb, 1.0);
  vec2 uv = corner_mix(coordinates, face, b).xy;
  ivec2 at = ivec2(floor(uv * vec2(material.image.yz)));
  int x = wrapped(at.x, int(material.image.y), (material.image.w >> shift_wrap_u) & 3u);
  int y = wrapped(at.y, int(material.image.z), (material.image.w >> shift_wrap_v) & 3u);
  return cell_color(texel_at(texels0, material.image, at).rgb, (x + y) % 2);
}
