// First pass of the baseline, a reimplementation of the published DiffSoup viewer: samples all
// eight channels of every fragment, tests alpha, and stores features in two 8-bit targets.
#include "lattice.glsl"

uniform sampler2D lut0;  // f0..f3
uniform sampler2D lut1;  // f4..f6, alpha
uniform int lut_width;

flat in uint face;
in vec2 barycentrics;

layout(location = 0) out vec4 target0;
layout(location = 1) out vec4 target1;

ivec2 lut_position(uint index) {
  return ivec2(int(index) % lut_width, int(index) / lut_width);
}

void main() {
  const uint n = 1u << LATTICE_LEVEL;
  uint first = face * ((n + 1u) * (n + 2u) / 2u);
  LatticeFootprint at = lattice_footprint(LATTICE_LEVEL, barycentrics);
  vec4 a = vec4(0.0), b = vec4(0.0);
  for (int k = 0; k < 3; ++k) {
    ivec2 texel = lut_position(first + at.texels[k]);
    a += at.weights[k] * texelFetch(lut0, texel, 0);
    b += at.weights[k] * texelFetch(lut1, texel, 0);
  }
  if (b.a < ALPHA_THRESHOLD) discard;
  target0 = a;
  target1 = vec4(b.rgb, 1.0);
}
