// Colour at once, for appearances so cheap that a second pass would cost more.
#include "appearance.glsl"
#include "view_direction.glsl"

flat in uint face;
in vec2 barycentrics;

layout(location = 0) out vec4 color;

void main() {
#if ALPHA_TEST
  if (!fragment_exists(face, barycentrics)) discard;
#endif
  color = vec4(fragment_color(face, barycentrics, direction_to_eye(gl_FragCoord.xy)), 1.0);
}
