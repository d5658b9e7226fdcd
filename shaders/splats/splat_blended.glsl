// Output of a splat's fragment. OUTPUT is one of the OUTPUT_.. constants, SplatOutput in C++: its
// colour, or what is measured of a pixel besides its colour. WRITE_SPLAT evaluates only those of its
// arguments that the output needs; the inputs of the others may not exist.

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
#define WRITE_SPLAT(color, alpha, depth, normal, opacity, sigma) blend(color, alpha)
#elif OUTPUT == OUTPUT_SAMPLE
flat in uint sampled_splat;
uniform int layer;
uniform float nearest;       // the near plane
uniform vec2 sample_corner;  // of the target in the whole image, in samples

layout(location = 0) out vec4 sampled;

// Evenly distributed in [0, 1), as if independent for every sample of the image, splat and layer:
// pcg3d of Jarzynski and Olano, Hash Functions for GPU Rendering, JCGT 9(3), 2020.
float random() {
  ivec2 at = ivec2(floor(vec2(sample_corner.x + gl_FragCoord.x, sample_corner.y - gl_FragCoord.y)));
  uvec3 v = uvec3(at, sampled_splat ^ (uint(layer) << 24));
  v = v * 1664525u + 1013904223u;
  for (int i = 0; i < 2; ++i) {
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    if (i == 0) v ^= v >> 16u;
  }
  return float(v.x >> 8) / 16777216.0;
}

// Opaque with probability alpha, if it is in front of the soups. `depth` is that of the fragment.
void sample_splat(vec3 color, float alpha, float depth) {
  if (!is_blended(alpha) || !(depth >= nearest && depth < depth_behind()) ||
      random() >= min(alpha, MAX_ALPHA))
    discard;
  sampled = vec4(color, 1.0);
}

void blend_nothing() { discard; }
#define WRITE_SPLAT(color, alpha, depth, normal, opacity, sigma) sample_splat(color, alpha, depth)
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
#define WRITE_SPLAT(color, alpha, depth, normal, opacity, sigma) measure(alpha, depth, normal, opacity, sigma)
#endif
