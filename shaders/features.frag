// Stores the features of the winning fragment of each pixel, for feature_shading.frag.
#include "appearance.glsl"
#include "simplex.glsl"

flat in uint face;
in vec2 barycentrics;

layout(location = 0) out vec4 stored_features0;
layout(location = 1) out vec4 stored_features1;

void main() {
  vec2 b = clamped_to_simplex(barycentrics);
#if ALPHA_TEST
  if (!fragment_exists(face, b)) discard;
#endif
  fragment_features(face, b, stored_features0, stored_features1);
}
