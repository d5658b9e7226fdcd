in vec2 deviations;
flat in vec4 color;
#if AS_PUBLISHED
flat in vec4 tiles;
#include "splat_tiles.glsl"
#endif

#include "splat_blended.glsl"

void main() {
#if AS_PUBLISHED
  blended = vec4(0.0);
  if (!is_in_tiles(tiles, gl_FragCoord.xy)) return;
#endif
  blended = blended_color(color.rgb, color.a * exp(-0.5 * dot(deviations, deviations)));
}
