// The first triangles: at points from structure from motion, on Gaussians, at random points, or a
// mesh (DiffSoup, arXiv 2603.27151, section 4; Gaussians are ours). Their logits begin at 0,
// opacity one half and grey features, except for a mesh with colours.
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "scene/photographs.hpp"
#include "scene/region.hpp"
#include "scene/scene.hpp"
#include "scene/splats.hpp"
#include "trainer/common/random.hpp"
#include "trainer/diffsoup/config.hpp"
#include "trainer/diffsoup/model.hpp"

namespace tureen::trainer {

/// The initial model of training at level config.coarse_level, with config.initial_triangles faces.
/// Positions are relative to the centre of the region of interest (for a mesh: see from_scene). The
/// result depends only on the arguments, and is the same on every machine within rounding.
///
/// `start`: a scene with one layer, needed for config.initialisation mesh. The longest edges of a
/// mesh are bisected if it has fewer triangles. If it has more, all stay until the first pruning,
/// which needs their visible pixels. On a scene of Gaussians, see seeds_at_gaussians; without any
/// in it, the triangles begin as without a scene. Throws InputError if points are required and the
/// dataset has none, and the errors of region_of_interest.
Model initial_model(const Dataset& dataset, const Config& config, const Scene* start = nullptr);

/// Positions, sizes and orientations of triangles.
struct Seeds {
  std::vector<glm::dvec3> centers;  // in world coordinates
  std::vector<double> radii;        // circumradii
  /// Unit normals, one for each, or none: then orientations are random.
  std::vector<glm::dvec3> normals = {};
};

/// Two thirds of `count` come from farthest-point sampling, the others are uniform among the
/// remaining points. If there are too few points, all are used; the others lie near uniformly
/// chosen points, within the distance to the nearest neighbour. Points more than twice as far from
/// the median as 99.5 % of all points are skipped: they are errors of structure from motion, and
/// farthest-point sampling would choose them first.
///
/// Only one of several coincident points is used. If there is only one point, the others lie within
/// `lone_spacing` of it. `lone_spacing` is also the neighbour distance of a single triangle.
///
/// A circumradius is `radius` times the distance to the nearest other centre. The distance is the
/// mean over all centres, or with `local` the centre's own. With `local` it is at least a tenth of
/// the mean, because points may nearly coincide.
struct PointSeeds {
  std::size_t count;
  double radius;
  bool local = false;
  double lone_spacing = 1.0;
};
Seeds seeds_at_points(std::span<const DatasetPoint> points, const PointSeeds& options,
                      Random& random);

/// Seeds at the centres of Gaussians with an opacity of one half and more, or of all if there is no
/// such Gaussian; at 100,000 of them, if there are more. The normal of a seed is the shortest axis
/// of the nearest Gaussian. `origin`: of the splats' layer, in world coordinates.
Seeds seeds_at_gaussians(const Gaussians& gaussians, glm::dvec3 origin, const PointSeeds& options,
                         Random& random);

/// Points are uniform in the cube `region`. A fraction `far` lies around it instead, up to
/// `far_extent` half sides from its centre, uniform in the logarithm of the distance. A point
/// outside the images of all `views` is drawn again, up to 100 times. Circumradii are `radius`
/// times the mean distance to the nearest neighbour in the cube; outside they are proportional to
/// the distance from the centre.
struct RandomSeeds {
  std::size_t count;
  double radius;
  double far = 0.0;
  double far_extent = 1.0;
};
Seeds random_seeds(const Region& region, std::span<const Photograph> views,
                   const RandomSeeds& options, Random& random);

/// Three corners per seed, relative to `origin`: equilateral, turned at random around the normal,
/// or with an orientation uniform in SO(3).
std::vector<glm::vec3> equilateral_triangles(const Seeds& seeds, glm::dvec3 origin, Random& random);

}  // namespace tureen::trainer
