// Sums of harmonics with stored coefficients.
#include "harmonics.glsl"
#include "texel_store.glsl"

uniform sampler2DArray coefficients;  // HARMONICS_COUNT texels an element: a face, a corner or a splat

// 1/2 + sum_i Y_i(d) c_i of an element. `d` is of unit length.
vec3 harmonics_color(uint element, vec3 d) {
  float basis[HARMONICS_COUNT];
  harmonics_basis(d, basis);
  vec3 sum = vec3(0.5);
  for (int i = 0; i < HARMONICS_COUNT; ++i)
    sum += basis[i] *
           texelFetch(coefficients, texel_position(element * uint(HARMONICS_COUNT) + uint(i)), 0).rgb;
  return sum;
}
