in vec3 distances;
flat in vec4 color;
flat in float sigma;
#if COLORS_PER_SPLAT == 3
in vec4 weighted_color;
#endif
#if MEASURES || OUTPUT == OUTPUT_SAMPLE
in float weight;
flat in float unit;
#endif
#if MEASURES
flat in vec3 normal;
#endif

#include "splat_depth_behind.glsl"
#include "splat_blended.glsl"

void main() {
  float rho = clamp(min(distances.x, min(distances.y, distances.z)) * gl_FragCoord.w, 0.0, 1.0);
  // pow(0, sigma) may be undefined; there alpha is 0.
  float window = rho > 0.0 ? pow(rho, sigma) : 0.0;
#if COLORS_PER_SPLAT == 3
  vec3 rgb = weighted_color.rgb / weighted_color.w;
#else
  vec3 rgb = color.rgb;
#endif
  WRITE_SPLAT(rgb, color.a * window, unit / (gl_FragCoord.w * weight), normal, color.a, sigma);
}
