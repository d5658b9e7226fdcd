// shading.frag as a compute shader: one invocation a pixel, in square groups. It is the only shader
// that needs GLSL 4.30 or ES 3.10. With DEPTH_REJECTS_BACKGROUND, the target already has the
// background's colour.
#include "visible_color.glsl"

layout(local_size_x = GROUP_SIDE, local_size_y = GROUP_SIDE) in;

layout(rgba8, binding = 0) writeonly uniform highp image2D shaded;
#if !DEPTH_REJECTS_BACKGROUND
uniform vec4 background;
#endif

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = textureSize(visible, 0);
  if (pixel.x >= size.x || pixel.y >= size.y) return;
  uvec2 fragment = texelFetch(visible, pixel, 0).xy;
  if (fragment.x == NO_FACE) {
#if !DEPTH_REJECTS_BACKGROUND
    imageStore(shaded, pixel, background);
#endif
    return;
  }
  imageStore(shaded, pixel, visible_color(fragment, vec2(pixel) + 0.5));
}
