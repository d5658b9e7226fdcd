in vec2 deviations;
flat in vec4 color;
#if AS_PUBLISHED
flat in vec4 tiles;
#include "splat_tiles.glsl"
#endif
#if MEASURES
flat in vec3 normal;
#endif
#if MEASURES || OUTPUT == OUTPUT_SAMPLE
flat in float center_depth;
#endif

#include "splat_depth_behind.glsl"
#include "splat_blended.glsl"

void main() {
#if AS_PUBLISHED
  if (!is_in_tiles(tiles, gl_FragCoord.xy)) {
    blend_nothing();
    return;
  }
#endif
  float alpha = color.a * exp(-0.5 * dot(deviations, deviations));
  WRITE_SPLAT(color.rgb, alpha, center_depth, normal, color.a, 0.0);
}
