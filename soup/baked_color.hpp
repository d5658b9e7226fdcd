// Colour without the network: what the color MLP of a lattice texture says is fitted, texel by
// texel, by harmonics of the direction. A knob: its error depends on the scene.
//
// Convention: harmonics take the unit direction from the surface to the eye, and the colour at a
// point is what the interpolated coefficients say for the pixel's own direction, clamped to [0, 1]
// there and nowhere before, but for the constant part, which texels hold and which is clamped.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <vector>

#include "soup/triangle_soup.hpp"

namespace tureen {

/// The directions of the fit: 32 of Fibonacci's, nearly uniform on the sphere, for faces are seen
/// from both sides. On them the basis up to degree 2 is orthogonal up to a few hundredths, and the
/// fit is least squares all the same.
std::vector<glm::vec3> bake_directions();

struct BakeOptions {
  int degree = 2;  // 0..2
  /// Called now and then with the fraction done, 0..1; may throw to abandon the work.
  std::function<void(double)> progress = {};
};

/// The texture without its network: features 0..2 are the constant part of the fit, the rest of the
/// features 0, and from degree 1 on `harmonics` holds the other coefficients. Bytes stay bytes:
/// coefficients then are multiples of scale / 127, with the scale a quarter above the largest of
/// every sixteenth texel, and clamped beyond. Texels that no visible point of a face lies next to
/// keep their features 0..2 and have no harmonics. Without a network the texture is returned as it
/// is. About two seconds for a million texels on one core.
LatticeTexture baked_color(const LatticeTexture& texture, const BakeOptions& options);

/// The texture without its network: features 0..2 are the colour.
LatticeTexture base_color(LatticeTexture texture);

}  // namespace tureen
