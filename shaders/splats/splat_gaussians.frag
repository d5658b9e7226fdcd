in vec2 deviations;
flat in vec4 color;
#if OUTPUT != OUTPUT_COLOR
flat in vec3 normal;
flat in float center_depth;
#endif

#include "splat_blended.glsl"

void main() {
  float alpha = color.a * exp(-0.5 * dot(deviations, deviations));
#if OUTPUT == OUTPUT_COLOR
  blend(color.rgb, alpha);
#else
  measure(alpha, center_depth, normal, color.a, 0.0);
#endif
}
