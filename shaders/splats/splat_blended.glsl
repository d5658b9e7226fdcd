// Output of a splat's fragment. OUTPUT is one of the OUTPUT_.. constants, SplatOutput in C++: its
// colour, or what is measured of a pixel besides its colour.

// False for NaN, of which min() may make MAX_ALPHA (docs/numerics.md, B3).
bool is_blended(float alpha) { return alpha >= MIN_ALPHA && MAX_ALPHA >= MIN_ALPHA; }

#if OUTPUT == OUTPUT_COLOR
layout(location = 0) out vec4 blended;  // premultiplied, for blending front to back

void blend(vec3 color, float alpha) {
  float limited = min(alpha, MAX_ALPHA);
  // Zero instead of discard, which is slower on software devices.
  blended = is_blended(alpha) ? vec4(color * limited, limited) : vec4(0.0);
}

void blend_nothing() { blended = vec4(0.0); }
#else
#include "splat_prefixes.glsl"

flat in int place;          // in the order of blending
uniform float world_scale;  // world units a layer unit
uniform usampler2D bounds;  // of the search (splat_search.frag)

layout(location = 0) out vec4 measured;
#if OUTPUT == OUTPUT_SUMS
layout(location = 1) out vec4 measured_more;
#endif

// Depth in layer units, normal in world axes.
void measure(float alpha, float depth, vec3 normal, float opacity, float sigma) {
  if (!is_blended(alpha)) discard;
  alpha = min(alpha, MAX_ALPHA);
#if OUTPUT == OUTPUT_SUMS
  measured = alpha * vec4(normal, 1.0);
  measured_more = alpha * vec4(world_scale * depth, opacity, sigma, 1.0);
#else
  uvec2 range = texelFetch(bounds, ivec2(gl_FragCoord.xy), 0).xy;
#if OUTPUT == OUTPUT_PREFIXES
  measured = alpha * vec4(lessThan(uvec4(place), tested_prefixes(range)));
#elif OUTPUT == OUTPUT_DEPTH_FOUND
  if (uint(place) + 1u != range.y) discard;
  measured = vec4(world_scale * depth);
#else
  measured = vec4(1.0, uint(place) + 1u < range.y ? 1.0 : 0.0, 0.0, float(place));
#endif
#endif
}

void blend_nothing() { discard; }
#endif
