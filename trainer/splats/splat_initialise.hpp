// The first splats of a training: at points of the dataset, at random points, on the triangles of a
// scene, or those of a scene.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <vector>

#include "scene/photographs.hpp"
#include "scene/region.hpp"
#include "scene/scene.hpp"
#include "trainer/common/random.hpp"
#include "trainer/common/random_points.hpp"
#include "trainer/splats/splat_config.hpp"
#include "trainer/splats/splat_state.hpp"

namespace tureen::trainer {

/// How first splats are found in photographs.
struct Search {
  int threads = 0;                                     // 0: one per core
  std::function<void(double fraction)> progress = {};  // may be empty, and may throw
};

struct ColoredPoint {
  glm::dvec3 position;    // relative to the region's centre
  glm::vec3 color{0.5f};  // display-referred
};

/// config.first_splats grey splats, at most config.max_splats, uniform in the cube of the region.
/// Each has a size in proportion to the side of a cube that is its share of the volume. The last
/// ones are around the region, as SplatConfig::far_splats says, and larger in proportion to their
/// distance.
template <class Training>
typename Training::Parameters random_splats(const typename Training::Config& config,
                                            const Region& region, Random& random) {
  const auto count = std::size_t(std::min(config.first_splats, config.max_splats));
  typename Training::Parameters result(count, config.degree);
  const double side = 2 * region.half_side / std::cbrt(double(std::max<std::size_t>(count, 1)));
  const auto near = count - std::size_t(config.far_splats * double(count));
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec3 point =
        i < near ? near_point(region, random) : far_point(region, config.far_extent, random);
    const double distance = glm::distance(point, region.center) / region.half_side;
    Training::put(config, {.position = point},
                  Training::size_of_share(config, side) * (i < near ? 1 : distance), random, i,
                  result);
  }
  return result;
}

/// The first splats, with positions relative to the centre of `region`, of the size that
/// Training::size_at_point gives, and with config.first_opacity.
///
/// Points: at most config.max_splats of them, with their colours. Further random ones in the region
/// make up config.first_splats. With Initialisation::automatic and
/// config.far_splats, for a place, a dataset without points gets stereo_points() from its images.
///
/// `start`: the scene of Initialisation::mesh, or one that replaces the others, or null; it has one
/// layer. Splats of the method's kernel are taken as they are, in world coordinates; Gaussians
/// become neural densities. Triangles become windows, or give points for other kernels.
///
/// Throws InputError if points are required and the dataset has none, for a scene without triangles
/// or splats of the kernel, and for one with more splats than config.max_splats; UsageError for a
/// scene with several layers.
template <class Training>
typename Training::Parameters initial_splats(const Dataset& dataset,
                                             const typename Training::Config& config,
                                             const Region& region, const Scene* start,
                                             Random& random, const Search& search = {});

/// The state before the first step, with initial_splats().
template <class Training>
SplatState<typename Training::Parameters> first_splats(const Dataset& dataset,
                                                       const typename Training::Config& config,
                                                       const Region& region,
                                                       const Scene* start = nullptr,
                                                       const Search& search = {}) {
  SplatState<typename Training::Parameters> state{.random = Random(config.seed)};
  state.parameters = initial_splats<Training>(dataset, config, region, start, state.random, search);
  state.memory = SplatMemory(state.parameters.rows(), state.parameters.count());
  return state;
}

/// `count` points on the triangles of a scene with one layer, uniform in area, with the mean
/// colours of the triangles. Throws InputError if no triangle has an area.
std::vector<ColoredPoint> points_on_triangles(const Scene& scene, const Region& region,
                                              std::size_t count, Random& random);

}  // namespace tureen::trainer
