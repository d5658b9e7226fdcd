// Colour in the only pass, for appearances that cost less than a second pass.
#include "appearance.glsl"
#include "simplex.glsl"
#include "view_direction.glsl"

flat in uint face;
in vec2 barycentrics;

layout(location = 0) out vec4 color;

void main() {
  vec2 b = clamped_to_simplex(barycentrics);
#if ALPHA_TEST
  if (!fragment_exists(face, b)) discard;
#endif
  color = vec4(fragment_color(face, b, direction_to_eye(gl_FragCoord.xy)), 1.0);
}
