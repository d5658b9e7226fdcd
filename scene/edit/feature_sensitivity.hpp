// Sensitivity of the colour to the features of a lattice texture, seen from the scene's cameras, by
// central differences through the color MLP.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "scene/triangle_soup.hpp"

namespace tureen {

/// A symmetric matrix over the features.
using FeatureMatrix =
    std::array<std::array<double, LatticeTexture::features>, LatticeTexture::features>;

/// The mean S of J^T J, where J (3 x 7) is the derivative of the colour by the features, both in
/// [0, 1]. A small change x of the features of all texels causes a mean squared error of x^T S x,
/// summed over the three colour channels.
///
/// The mean is over `samples` visible texels (alpha at least alpha_threshold). Each is seen from
/// one of `eyes` (relative to the soup's origin, at least one). The seed is fixed, so the same soup
/// gives the same matrix. Faces are chosen in proportion to `shown`, the number of pixels that show
/// each face (at least 0, with a finite sum above 0); if it is empty, uniformly. Without a color
/// MLP features 0..2 are the colour. The result is zero if no sample is visible. The soup must have
/// a lattice texture and no defect().
FeatureMatrix mean_sensitivity(const TriangleSoup& soup, std::span<const glm::dvec3> eyes,
                               std::span<const double> shown = {}, int samples = 60000);

/// The squared change of colour for each face: the visibility of the same loss on each face. It is
/// summed over the colour channels and over the `steps`, and averaged over a few texels of the face
/// and a few eyes. Each step is a change of all features, applied half to either side. The other
/// parameters are as above.
std::vector<double> face_sensitivity(
    const TriangleSoup& soup, std::span<const glm::dvec3> eyes,
    std::span<const std::array<double, LatticeTexture::features>> steps);

}  // namespace tureen
