// The stored values of splats: KERNEL_TEXELS texels each (texel_rows in splatting/).
#include "texel_store.glsl"

uniform sampler2DArray kernel;

vec4 kernel_texel(uint splat, int i) {
  return texelFetch(kernel, texel_position(splat * uint(KERNEL_TEXELS) + uint(i)), 0);
}

// Columns are the local axes of a unit quaternion (x, y, z, w).
mat3 rotation_of(vec4 q) {
  vec3 d = 2.0 * q.xyz;
  float xx = d.x * q.x, yy = d.y * q.y, zz = d.z * q.z;
  float xy = d.x * q.y, xz = d.x * q.z, yz = d.y * q.z;
  vec3 w = d * q.w;
  return mat3(1.0 - yy - zz, xy + w.z, xz - w.y, xy - w.z, 1.0 - xx - zz, yz + w.x, xz + w.y,
              yz - w.x, 1.0 - xx - yy);
}

// The power of two at or below a float > 0, so that dividing by it is exact. Squares of lengths in
// this unit neither overflow nor underflow (docs/numerics.md, N10).
float power_of_two_below(float x) {
  return uintBitsToFloat(max(floatBitsToUint(x) & 0x7f800000u, 0x00800000u));
}
