// The colour of a pixel's count from fragment_count.frag.
#include "heat_ramp.glsl"

uniform sampler2D counts;
uniform vec4 background;

layout(location = 0) out vec4 color;

void main() {
  float count = 255.0 * texelFetch(counts, ivec2(gl_FragCoord.xy), 0).r;
  color = count < 0.5 ? background : vec4(count_color(count), 1.0);
}
