// Photographs of a model: what a trainer is given to learn it from.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "examples/light.hpp"
#include "examples/light_map.hpp"
#include "examples/noise.hpp"
#include "examples/ray_caster.hpp"
#include "examples/surface.hpp"
#include "image/image.hpp"
#include "scene/camera.hpp"

namespace tureen::example {

struct StudioOptions {
  double light_spacing = 0.025;  // see LightMap; shadows are soft over about 0.1
  LightQuality light = {};
  int threads = 1;  // for the light; no number of them changes an image
};

/// Light that is good enough for images of 64 pixels a side, in a second.
inline constexpr StudioOptions draft_light{.light_spacing = 0.1,
                                           .light = {.sky_rays = 48, .window_rays = 12}};

/// A model with its light, ready to be photographed.
class Studio {
 public:
  explicit Studio(Model model, const StudioOptions& options = {});
  Studio(const Studio&) = delete;
  Studio& operator=(const Studio&) = delete;

  /// Straight alpha: the part of the pixel that the model covers; the colour is the mean of the
  /// displayed colours of that part. `strata` squared rays a pixel, one in each cell of a grid, so
  /// that edges are soft; the glaze mirrors the room, and whatever stands around it, a little
  /// blurred. The same image every time. Safe to call from several threads.
  Image8 photograph(const Camera& camera, int strata) const;

 private:
  /// The displayed colour that comes to the eye from this direction, if anything stands there.
  std::optional<glm::dvec3> seen(glm::dvec3 eye, glm::dvec3 direction, Random& random) const;

  Model model_;
  RayCaster caster_;
  Light light_;
  LightMap light_map_;
};

/// `count` cameras spread evenly (a Fibonacci spiral) over the upper hemisphere, from nearly above
/// to a little below the table's top: square images of `size` pixels a side that hold the whole
/// still life. `turn` in [0, 0.5] moves all along the spiral by a part of a step: views to train on
/// and views to test on differ in it. y is up, as in the model; names are r_000, r_001, ..
std::vector<Camera> example_cameras(int count, int size, double turn = 0);

}  // namespace tureen::example
