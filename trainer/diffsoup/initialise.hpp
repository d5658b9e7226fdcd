// Where the first triangles are: at points of structure from motion, at random, or a mesh
// (DiffSoup, arXiv 2603.27151, section 4). All begin at logits of 0, with opacity one half and grey
// features, but for those of a mesh that has colours.
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "scene/photographs.hpp"
#include "scene/scene.hpp"
#include "trainer/common/random.hpp"
#include "trainer/common/region.hpp"
#include "trainer/diffsoup/config.hpp"
#include "trainer/diffsoup/model.hpp"

namespace tureen::trainer {

/// The model that training begins with, on the level config.coarse_level: config.initial_triangles
/// faces, positions relative to the centre of the region of interest (a mesh: see from_scene). A
/// function of its arguments alone, the same on every machine but for rounding.
///
/// `mesh` is there exactly where config.initialisation is mesh; where it has fewer triangles its
/// longest edges are bisected, where it has more it keeps them all: pruning needs to see them
/// first. Throws InputError where points are asked for and there are none, and what
/// region_of_interest throws.
Model initial_model(const Dataset& dataset, const Config& config, const Scene* mesh = nullptr);

/// Where triangles are put, and how large.
struct Seeds {
  std::vector<glm::dvec3> centres;  // in world coordinates
  std::vector<double> radii;        // circumradii
};

/// Two thirds of `count` by farthest-point sampling, the others uniform among the points that are
/// left. Where there are too few points all are taken, and the others lie beside points chosen
/// uniformly, within the distance of their nearest neighbours. Of the points, the farthest half
/// percent is left out where it is twice as far from the median as the rest: mistakes of
/// structure from motion that farthest-point sampling would find first.
///
/// Of points that coincide one is taken. Where there is but one, the others lie within
/// `lone_spacing` of it, and a lone triangle's neighbour is taken to be as far away.
///
/// A circumradius is `radius` times the distance to the nearest other centre: its mean, or
/// (`local`) that of the centre itself, but at least a tenth of the mean, as
/// points may nearly coincide.
struct PointSeeds {
  std::size_t count;
  double radius;
  bool local = false;
  double lone_spacing = 1.0;
};
Seeds seeds_at_points(std::span<const DatasetPoint> points, const PointSeeds& options,
                      Random& random);

/// Uniform in the cube `region`, but for a fraction `far` that lies around it, out to `far_extent`
/// half sides from its centre, uniform in the logarithm of the distance. What no camera of `views`
/// has in its image is drawn again, a hundred times at most. Circumradii are `radius` times the
/// mean distance to the nearest neighbour in the cube; outside of it they grow like the distance
/// from the centre.
struct RandomSeeds {
  std::size_t count;
  double radius;
  double far = 0.0;
  double far_extent = 1.0;
};
Seeds random_seeds(const Region& region, std::span<const Photograph> views,
                   const RandomSeeds& options, Random& random);

/// Three corners a seed, relative to `origin`: equilateral, uniform in SO(3).
std::vector<glm::vec3> equilateral_triangles(const Seeds& seeds, glm::dvec3 origin, Random& random);

}  // namespace tureen::trainer
