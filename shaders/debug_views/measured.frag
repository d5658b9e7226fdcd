// What is measured at each pixel, of the splats and of the soups behind them: the values, or the
// colours of a debug view. SHOWN is one of the SHOW_.. constants, DebugView in C++. A soup has the
// weight that the splats in front of it leave.
#include "heat_ramp.glsl"

uniform sampler2D first, second;  // SplatMeasures (runtime/splats/splat_measures.hpp)
uniform sampler2D surface;        // of the soups: normal and depth; 0 without a soup
uniform sampler2D counts;         // fragments of the soups (fragment_count.frag)
uniform vec4 background;
uniform vec2 depth_scale;   // depth_color()
uniform float splat_count;  // in the order of blending

layout(location = 0) out vec4 result;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 a = vec4(0.0), b = vec4(0.0), behind = vec4(0.0);
#if HAS_SPLATS
  a = texelFetch(first, pixel, 0);
  b = texelFetch(second, pixel, 0);
#endif
#if HAS_SOUPS
  behind = texelFetch(surface, pixel, 0);
#endif
  float alpha = a.w;
  float through = behind.w > 0.0 ? 1.0 - alpha : 0.0;
  bool is_there = alpha > 0.0 || behind.w > 0.0;
  vec3 value = vec3(0.0), shown = vec3(0.0);
#if SHOWN == SHOW_DEPTH || SHOWN == SHOW_MEDIAN_DEPTH
#if SHOWN == SHOW_DEPTH
  float depth = (b.x + through * behind.w) / (alpha + through);
#else
  float depth = a.x > 0.0 ? a.x : behind.w;
  is_there = depth > 0.0;
#endif
  value = vec3(depth);
  shown = depth_color(depth, depth_scale);
#elif SHOWN == SHOW_NORMALS
  vec3 sum = a.xyz + through * behind.xyz;
  value = dot(sum, sum) > 0.0 ? normalize(sum) : vec3(0.0);
  shown = 0.5 * value + 0.5;
#elif SHOWN == SHOW_ALPHA
  value = vec3(alpha + through);
  shown = vec3(alpha);  // over the soups' colours
#elif SHOWN == SHOW_OPACITY
  value = shown = vec3(b.y / alpha);
#elif SHOWN == SHOW_SIGMA
  value = vec3(b.z / alpha);
  shown = value / (1.0 + value);
#elif SHOWN == SHOW_OVERDRAW
  value = vec3(a.x);
#if HAS_SOUPS
  value += 255.0 * texelFetch(counts, pixel, 0).r;
#endif
  is_there = value.x > 0.0;
  shown = count_color(max(value.x, 1.0));
#elif SHOWN == SHOW_CONTRIBUTIONS
  value = vec3(a.y);
  is_there = a.x > 0.0;
  shown = count_color(max(value.x, 1.0));
#elif SHOWN == SHOW_ORDER
  value = vec3(a.w);
  is_there = a.x > 0.0;
  shown = heat_ramp(1.0 - a.w / splat_count);
#endif
#if VALUES
  result = is_there ? vec4(value, 1.0) : vec4(0.0);
#elif SHOWN == SHOW_ALPHA
  if (!(alpha > 0.0)) discard;
  result = vec4(shown, behind.w > 0.0 ? alpha : 1.0);
#else
  result = is_there ? vec4(shown, 1.0) : background;
#endif
}
