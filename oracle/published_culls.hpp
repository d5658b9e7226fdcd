// The culls in the authors' code that depend on the resolution.
//
// Triangle Splatting (forward.cu of its rasteriser) skips a window if the largest distance in the
// image between a corner and the centre is above 1600 pixels or below 1, if its inradius in the
// image is below 1 pixel, or if the cosine between its normal and the direction to its centre is
// below 1e-3. It divides by the depth of a corner behind the eye as by any other.
//
// 3DGS, Mip-Splatting and 2DGS draw a Gaussian only in the tiles of 16 x 16 pixels that a square
// touches (getRect() in auxiliary.h). 3DGS: the square's middle is the image of the Gaussian's
// centre, and half its side is ceil(3 sqrt(m + sqrt(max(0.1, m^2 - det)))), with half the trace m
// and the determinant det of the covariance. 2DGS: the square's middle is that of the box around
// three standard deviations, and half its side is ceil(max(3 sqrt(1/2), half the box's longer
// side)).
//
// REdiSplats has no such rule, and the tiles of Splat the Net are larger than its splats.
#pragma once

#include <array>

#include "oracle/splat_view.hpp"

namespace tureen::oracle {

/// Whether Triangle Splatting draws the window with these corners, in view coordinates.
bool is_published_window(const SplatView& view, const std::array<glm::dvec3, 3>& corners);

/// The tiles of a Gaussian by EWA with its centre at an image point, and the entries of its
/// covariance.
ImageBox published_tiles_of_gaussian(const glm::dvec2& center, double xx, double xy, double yy);

/// The tiles of the disc with this centre and axes of one deviation, in view coordinates.
ImageBox published_tiles_of_disc(const SplatView& view, const glm::dvec3& center,
                                 const glm::dvec3& u_axis, const glm::dvec3& v_axis);

/// Whether a point of the image is in the tiles. Pixel centres are never on their border.
bool contains(const ImageBox& tiles, const glm::dvec2& pixel);

}  // namespace tureen::oracle
