// The backing layer of a scene: a sphere of coarse triangles around it. Every ray of a camera
// inside ends there, if no nearer face stops it, so no pixel shows the background. Its corners stay
// in place, and resampling does not change it; its textures are trained like all others.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "scene/photographs.hpp"
#include "scene/region.hpp"
#include "trainer/diffsoup/config.hpp"

namespace tureen::trainer {

/// The number of backing triangles, 20 * 4^n or 0. They are the first faces of the model. At most
/// config.backing_triangles and a hundredth of the budget; 0 if the first primitives are those of a
/// scene.
std::size_t backing_faces(const Config& config);

/// The radius around the region's centre, in world units: beyond the far random points and all
/// training cameras, except those that are much farther away than nine tenths of them.
double min_backing_radius(const Config& config, const Dataset& dataset, const Region& region);

/// Config::far at least so large that the training cameras see the whole sphere of that radius.
Config with_visible_backing(const Config& config, const Dataset& dataset, const Region& region);

/// The radius for first triangles at these centres (both in world units): beyond all of them, as
/// far as the far plane allows.
double backing_radius(const Config& config, const Dataset& dataset, const Region& region,
                      std::span<const glm::dvec3> centers);

/// Three corners for each of `faces` triangles (a value of backing_faces()): a subdivided
/// icosahedron around the origin.
std::vector<glm::vec3> backing_sphere(std::size_t faces, double radius);

}  // namespace tureen::trainer
