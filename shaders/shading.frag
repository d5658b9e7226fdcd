// Colours the covered pixels of the visibility pass.
#include "visible_color.glsl"

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
  color = visible_color(fragment, gl_FragCoord.xy);
}
