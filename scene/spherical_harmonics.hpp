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

/// Y_00, the constant basis function: 1 / (2 sqrt(pi)).
inline constexpr double y00 = 0.28209479177387814;

/// All 25 basis values at the unit direction `d`; entry l*l + l + m is Y_lm. `d` must be
/// normalised. For other lengths, bands 0 to 3 scale by |d|^l, and some functions of band 4 are
/// wrong.
template <class Real>
std::array<Real, 25> basis(const glm::vec<3, Real>& d) {
  const Real x = d.x, y = d.y, z = d.z;
  const Real xx = x * x, yy = y * y, zz = z * z, xy = x * y, yz = y * z, xz = x * z;
  return {
      Real(0.28209479177387814),
      Real(-0.48860251190291992) * y,
      Real(0.48860251190291992) * z,
      Real(-0.48860251190291992) * x,
      Real(1.0925484305920792) * xy,
      Real(-1.0925484305920792) * yz,
      Real(0.31539156525252005) * (2 * zz - xx - yy),
      Real(-1.0925484305920792) * xz,
      Real(0.54627421529603959) * (xx - yy),
      Real(-0.59004358992664352) * y * (3 * xx - yy),
      Real(2.8906114426405538) * xy * z,
      Real(-0.45704579946446572) * y * (4 * zz - xx - yy),
      Real(0.37317633259011546) * z * (2 * zz - 3 * xx - 3 * yy),
      Real(-0.45704579946446572) * x * (4 * zz - xx - yy),
      Real(1.4453057213202769) * z * (xx - yy),
      Real(-0.59004358992664352) * x * (xx - 3 * yy),
      Real(2.5033429417967046) * xy * (xx - yy),
      Real(-1.7701307697799304) * yz * (3 * xx - yy),
      Real(0.94617469575756008) * xy * (7 * zz - 1),
      Real(-0.66904654355728921) * yz * (7 * zz - 3),
      Real(0.10578554691520431) * (zz * (35 * zz - 30) + 3),
      Real(-0.66904654355728921) * xz * (7 * zz - 3),
      Real(0.47308734787878004) * (xx - yy) * (7 * zz - 1),
      Real(-1.7701307697799304) * xz * (xx - 3 * yy),
      Real(0.62583573544917614) * (xx * (xx - 3 * yy) - yy * (3 * xx - yy)),
  };
}

}  // namespace tureen::harmonics
