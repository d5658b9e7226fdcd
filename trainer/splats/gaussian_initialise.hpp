// The first Gaussians of a training: at points of the dataset, at random points, on the triangles
// of a scene, or those of a scene.
#pragma once

#include "scene/photographs.hpp"
#include "scene/scene.hpp"
#include "trainer/common/random.hpp"
#include "trainer/common/region.hpp"
#include "trainer/splats/gaussian_config.hpp"
#include "trainer/splats/gaussian_parameters.hpp"

namespace tureen::trainer {

/// The first Gaussians, with positions relative to the centre of `region`. They are round, with a
/// scale of the mean distance to the three nearest others (as in 3DGS, arXiv 2308.04079), and have
/// config.first_opacity.
///
/// Points: at most config.max_splats of them, with their colours. Further random ones in the region
/// make up config.first_splats.
///
/// `start`: the scene for Initialisation::mesh, null for all others; it has one layer. Gaussians
/// are taken as they are, in world coordinates. Triangles get config.first_splats samples, in
/// proportion to their areas, with their mean colours.
///
/// Throws InputError if points are required and the dataset has none, and for a scene without
/// triangles or Gaussians; UsageError for a scene with several layers.
GaussianParameters initial_gaussians(const Dataset& dataset, const GaussianConfig& config,
                                     const Region& region, const Scene* start, Random& random);

}  // namespace tureen::trainer
