// Renders a model as photographs for a trainer.
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
  double light_spacing = 0.025;  // of LightMap; the penumbra of shadows is about 0.1 wide
  LightQuality light = {};
  int threads = 1;  // for the light; images do not depend on it
};

/// Light of sufficient quality for images with 64 pixels a side; takes about a second.
inline constexpr StudioOptions draft_light{.light_spacing = 0.1,
                                           .light = {.sky_rays = 48, .window_rays = 12}};

/// A model with its precomputed light.
class Studio {
 public:
  explicit Studio(Model model, const StudioOptions& options = {});
  Studio(const Studio&) = delete;
  Studio& operator=(const Studio&) = delete;

  /// Straight alpha: the covered part of the pixel. The colour is the mean of the displayed colours
  /// in that part. Each pixel has `strata` squared rays, one in each cell of a grid. Glaze reflects
  /// the background and other surfaces with a slight blur. Every call returns the same image. Safe
  /// to call from several threads.
  Image8 photograph(const Camera& camera, int strata) const;

 private:
  /// The displayed colour of the nearest surface in this direction, or nullopt.
  std::optional<glm::dvec3> seen(glm::dvec3 eye, glm::dvec3 direction, Random& random) const;

  Model model_;
  RayCaster caster_;
  Light light_;
  LightMap light_map_;
};

/// `count` cameras, evenly distributed on a Fibonacci spiral over the upper hemisphere, from nearly
/// above to slightly below the table top. The images are square with `size` pixels a side and show
/// the whole still life. `turn` in [0, 0.5] shifts all cameras along the spiral by a part of a
/// step; training and test views use different values. y is up, as in the model. Names are r_000,
/// r_001, ..
std::vector<Camera> example_cameras(int count, int size, double turn = 0);

}  // namespace tureen::example
