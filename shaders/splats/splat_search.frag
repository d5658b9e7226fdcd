// A step of the search for the splat at which a pixel's transmittance falls to a threshold. The
// transmittance behind the first bounds.x splats is above it, behind the first bounds.y not.
#include "splat_prefixes.glsl"

uniform usampler2D bounds;
uniform sampler2D transmittances;  // behind each of the tested prefixes
uniform float threshold;

layout(location = 0) out uvec2 narrowed;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  narrowed = texelFetch(bounds, pixel, 0).xy;
  uvec4 tested = tested_prefixes(narrowed);
  vec4 transmittance = texelFetch(transmittances, pixel, 0);
  for (int i = 0; i < 4; ++i) {
    if (transmittance[i] > threshold)
      narrowed.x = max(narrowed.x, tested[i]);
    else
      narrowed.y = min(narrowed.y, tested[i]);
  }
}
