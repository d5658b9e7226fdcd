in vec2 deviations;
flat in vec4 color;

#include "splat_blended.glsl"

void main() {
  blended = blended_color(color.rgb, color.a * exp(-0.5 * dot(deviations, deviations)));
}
