// Colours the pixels that the visibility pass has named.
#include "appearance.glsl"
#include "view_direction.glsl"

uniform usampler2D visible;  // written by visibility.frag
#if !DEPTH_REJECTS_BACKGROUND
uniform vec4 background;
#endif

layout(location = 0) out vec4 color;

void main() {
  uvec2 fragment = texelFetch(visible, ivec2(gl_FragCoord.xy), 0).xy;
#if !DEPTH_REJECTS_BACKGROUND
  if (fragment.x == NO_FACE) {
    color = background;
    return;
  }
#endif
  vec2 b = vec2(fragment.y & 0xffffu, fragment.y >> 16) / 65535.0;
  color = vec4(fragment_color(fragment.x, b, direction_to_eye(gl_FragCoord.xy)), 1.0);
}
