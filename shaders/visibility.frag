// Stores the visible fragment of each pixel instead of its features: the face, and two barycentrics
// of 16 bits (1/65535 of a face is 1/512 of a texel at level 7).
#include "appearance.glsl"
#include "simplex.glsl"

flat in uint face;
in vec2 barycentrics;

layout(location = 0) out uvec2 fragment;

#ifdef LAYERED
uniform int first_slot;  // slots of all layers are numbered in one sequence
#endif

void main() {
  vec2 b = clamped_to_simplex(barycentrics);
#if ALPHA_TEST
  if (!fragment_exists(face, b)) discard;
#endif
  uvec2 packed_b = uvec2(b * 65535.0 + 0.5);
  // Both may have been rounded up: without this the point would leave the triangle.
  packed_b.y = min(packed_b.y, 65535u - packed_b.x);
  fragment = uvec2(face, packed_b.x | (packed_b.y << 16));
#ifdef LAYERED
  fragment.x += uint(first_slot);
#endif
}
