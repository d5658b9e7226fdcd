// How much colour moves when the features of a lattice texture do, seen from where the scene is
// looked at: central differences through the color MLP.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "scene/triangle_soup.hpp"

namespace tureen {

/// Symmetric, of features.
using FeatureMatrix =
    std::array<std::array<double, LatticeTexture::features>, LatticeTexture::features>;

/// The mean of J^T J, where J (3 x 7) is how the colour follows the features: both in [0, 1]. A
/// small change x of the features of all texels makes a mean squared error of x^T S x, summed over
/// the three channels of colour.
///
/// The mean is over `samples` of visible texels (alpha at least alpha_threshold), each seen from
/// one of `eyes` (relative to the soup's origin, at least one), chosen by a fixed seed: the same
/// soup gives the same matrix. Faces are chosen in proportion to `shown`, how many pixels show each
/// say (at least 0, with a finite sum above 0), and all alike where it is empty. A texture without
/// a color MLP shows features 0..2 as they are. All zeros where no sample is visible. The soup has
/// a lattice texture and no defect().
FeatureMatrix mean_sensitivity(const TriangleSoup& soup, std::span<const glm::dvec3> eyes,
                               std::span<const double> shown = {}, int samples = 60000);

/// The squared movement of colour, summed over its channels and over the `steps` (each a change of
/// all features, made half to either side), in the mean over a few texels of each face and a few
/// eyes: how much the same loss shows on each face. As above.
std::vector<double> face_sensitivity(
    const TriangleSoup& soup, std::span<const glm::dvec3> eyes,
    std::span<const std::array<double, LatticeTexture::features>> steps);

}  // namespace tureen
