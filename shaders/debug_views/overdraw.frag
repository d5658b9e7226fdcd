// The colour of a pixel's count from fragment_count.frag, as overdraw_color() in
// runtime/debug_views/debug_view.cpp.
#include "heat_ramp.glsl"

uniform sampler2D counts;
uniform vec4 background;

layout(location = 0) out vec4 color;

void main() {
  float count = 255.0 * texelFetch(counts, ivec2(gl_FragCoord.xy), 0).r;
  color = count < 0.5 ? background : vec4(heat_ramp(log2(count) / 8.0), 1.0);
}
