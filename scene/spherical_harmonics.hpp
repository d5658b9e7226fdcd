// Real spherical harmonics of degree 0..4, in the order and signs that radiance-field codes share
// (Plenoxels, 3DGS, Triangle Splatting, DiffSoup). shaders/harmonics.glsl states the same basis; a
// test compares the two.
#pragma once

#include <array>
#include <glm/vec3.hpp>

namespace tureen::harmonics {

inline constexpr int max_degree = 4;

/// Basis functions up to and including `degree`: 1, 4, 9, 16, 25.
constexpr int count(int degree) { return (degree + 1) * (degree + 1); }

/// The factor of each basis function, as basis() states the rest of it.
inline constexpr double factors[] = {
    0.28209479177387814, -0.48860251190291992, 0.48860251190291992, -0.48860251190291992,
    1.0925484305920792,  -1.0925484305920792,  0.31539156525252005, -1.0925484305920792,
    0.54627421529603959, -0.59004358992664352, 2.8906114426405538,  -0.45704579946446572,
    0.37317633259011546, -0.45704579946446572, 1.4453057213202769,  -0.59004358992664352,
    2.5033429417967046,  -1.7701307697799304,  0.94617469575756008, -0.66904654355728921,
    0.10578554691520431, -0.66904654355728921, 0.47308734787878004, -1.7701307697799304,
    0.62583573544917614};

/// Y_00, the constant basis function: 1 / (2 sqrt(pi)).
inline constexpr double y00 = factors[0];

/// All 25 basis values at the unit direction `d`; entry l*l + l + m is Y_lm. `d` must be
/// normalised. For other lengths, bands 0 to 3 scale by |d|^l, and some functions of band 4 are
/// wrong.
template <class Real>
std::array<Real, 25> basis(const glm::vec<3, Real>& d) {
  const Real x = d.x, y = d.y, z = d.z;
  const Real xx = x * x, yy = y * y, zz = z * z, xy = x * y, yz = y * z, xz = x * z;
  return {
      Real(factors[0]),
      Real(factors[1]) * y,
      Real(factors[2]) * z,
      Real(factors[3]) * x,
      Real(factors[4]) * xy,
      Real(factors[5]) * yz,
      Real(factors[6]) * (2 * zz - xx - yy),
      Real(factors[7]) * xz,
      Real(factors[8]) * (xx - yy),
      Real(factors[9]) * y * (3 * xx - yy),
      Real(factors[10]) * xy * z,
      Real(factors[11]) * y * (4 * zz - xx - yy),
      Real(factors[12]) * z * (2 * zz - 3 * xx - 3 * yy),
      Real(factors[13]) * x * (4 * zz - xx - yy),
      Real(factors[14]) * z * (xx - yy),
      Real(factors[15]) * x * (xx - 3 * yy),
      Real(factors[16]) * xy * (xx - yy),
      Real(factors[17]) * yz * (3 * xx - yy),
      Real(factors[18]) * xy * (7 * zz - 1),
      Real(factors[19]) * yz * (7 * zz - 3),
      Real(factors[20]) * (zz * (35 * zz - 30) + 3),
      Real(factors[21]) * xz * (7 * zz - 3),
      Real(factors[22]) * (xx - yy) * (7 * zz - 1),
      Real(factors[23]) * xz * (xx - 3 * yy),
      Real(factors[24]) * (xx * (xx - 3 * yy) - yy * (3 * xx - yy)),
  };
}

}  // namespace tureen::harmonics
