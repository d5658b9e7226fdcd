// Triangle Splatting's primitives as data (arXiv 2505.19175): triangles with a soft window.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "scene/remark.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen {

/// Values after activation. The window at a fragment is rho^sigma, with rho = 1 at the incenter and
/// 0 on the edges; alpha = opacity * window.
struct SoftTriangles {
  std::vector<glm::vec3> positions;  // three a triangle
  std::vector<float> sigma;          // > 0, one a triangle
  std::vector<float> opacity;        // [0, 1], one a triangle
  int degree = 0;                    // of the harmonics, 0..4
  /// harmonics::count(degree) RGB coefficients a triangle, eye-to-centroid convention.
  std::vector<glm::vec3> coefficients;
};

/// Mean coverage of a soft triangle: opacity * 2 / ((sigma+1)(sigma+2)). The factor after opacity
/// is the mean of rho^sigma over the triangle.
double solidity(double opacity, double sigma);

struct OpaqueResult {
  TriangleSoup soup;
  std::vector<Remark> remarks;  // what was lost
};

/// Opaque faces with the same harmonics. Keeps every triangle with an opacity of at least
/// `minimum_opacity`. Triangle Splatting itself skips triangles below 0.01.
OpaqueResult to_opaque(SoftTriangles soft, float minimum_opacity = 0.01f);

}  // namespace tureen
