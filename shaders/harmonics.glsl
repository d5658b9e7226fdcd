// Real spherical harmonics up to HARMONICS_DEGREE (0..4) in the order of
// scene/spherical_harmonics.hpp; a test compares the two. `d` is of unit length.
#define HARMONICS_COUNT ((HARMONICS_DEGREE + 1) * (HARMONICS_DEGREE + 1))

// `v` with length 1. It is scaled first: squares of floats underflow below 1e-19 and overflow beyond
// 1e19. At 0 any direction is valid (docs/numerics.md, V5).
vec3 direction_of(vec3 v) {
  float largest = max(abs(v.x), max(abs(v.y), abs(v.z)));
  v *= largest > 1e15 ? 1e-20 : largest < 1e-15 ? 1e30 : 1.0;
  return largest > 0.0 ? v / length(v) : vec3(0.0, 0.0, 1.0);
}

void harmonics_basis(vec3 d, out float basis[HARMONICS_COUNT]) {
  float x = d.x, y = d.y, z = d.z;
  float xx = x * x, yy = y * y, zz = z * z, xy = x * y, yz = y * z, xz = x * z;
  basis[0] = 0.28209479177387814;
#if HARMONICS_DEGREE >= 1
  basis[1] = -0.48860251190291992 * y;
  basis[2] = 0.48860251190291992 * z;
  basis[3] = -0.48860251190291992 * x;
#endif
#if HARMONICS_DEGREE >= 2
  basis[4] = 1.0925484305920792 * xy;
  basis[5] = -1.0925484305920792 * yz;
  basis[6] = 0.31539156525252005 * (2.0 * zz - xx - yy);
  basis[7] = -1.0925484305920792 * xz;
  basis[8] = 0.54627421529603959 * (xx - yy);
#endif
#if HARMONICS_DEGREE >= 3
  basis[9] = -0.59004358992664352 * y * (3.0 * xx - yy);
  basis[10] = 2.8906114426405538 * xy * z;
  basis[11] = -0.45704579946446572 * y * (4.0 * zz - xx - yy);
  basis[12] = 0.37317633259011546 * z * (2.0 * zz - 3.0 * xx - 3.0 * yy);
  basis[13] = -0.45704579946446572 * x * (4.0 * zz - xx - yy);
  basis[14] = 1.4453057213202769 * z * (xx - yy);
  basis[15] = -0.59004358992664352 * x * (xx - 3.0 * yy);
#endif
#if HARMONICS_DEGREE >= 4
  basis[16] = 2.5033429417967046 * xy * (xx - yy);
  basis[17] = -1.7701307697799304 * yz * (3.0 * xx - yy);
  basis[18] = 0.94617469575756008 * xy * (7.0 * zz - 1.0);
  basis[19] = -0.66904654355728921 * yz * (7.0 * zz - 3.0);
  basis[20] = 0.10578554691520431 * (zz * (35.0 * zz - 30.0) + 3.0);
  basis[21] = -0.66904654355728921 * xz * (7.0 * zz - 3.0);
  basis[22] = 0.47308734787878004 * (xx - yy) * (7.0 * zz - 1.0);
  basis[23] = -1.7701307697799304 * xz * (xx - 3.0 * yy);
  basis[24] = 0.62583573544917614 * (xx * (xx - 3.0 * yy) - yy * (3.0 * xx - yy));
#endif
}
