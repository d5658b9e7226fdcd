// Names the winning fragment of each pixel instead of storing its features: the face, and two
// barycentrics of 16 bits (1/65535 of a face is 1/512 of a texel at level 7).
#include "appearance.glsl"

flat in uint face;
in vec2 barycentrics;

layout(location = 0) out uvec2 fragment;

void main() {
#if ALPHA_TEST
  if (!fragment_exists(face, barycentrics)) discard;
#endif
  uvec2 b = uvec2(clamp(barycentrics, 0.0, 1.0) * 65535.0 + 0.5);
  fragment = uvec2(face, b.x | (b.y << 16));
}
