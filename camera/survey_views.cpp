#include "camera/survey_views.hpp"

#include <algorithm>
#include <utility>

#include "camera/camera_sets.hpp"
#include "camera/navigation.hpp"

namespace tureen {

std::vector<Camera> survey_views(const Scene& scene, std::size_t count, int side) {
  constexpr double near_distance = 1.0 / 3;
  std::vector<Camera> views;
  const std::size_t recorded = std::min(scene.cameras.size(), count / 2);
  for (std::size_t i = 0; i < recorded; ++i) {
    const Camera& camera = scene.cameras[i * scene.cameras.size() / recorded];
    const double scale = double(side) / std::max(camera.width, camera.height);
    views.push_back(scale >= 1 ? camera
                               : resized(camera, std::max(1, int(camera.width * scale)),
                                         std::max(1, int(camera.height * scale))));
  }
  const Subject subject = subject_of(scene);
  const std::vector<Camera> around =
      hemisphere(subject, int(count - recorded), Lens{.width = side, .height = side});
  for (std::size_t i = 0; i < around.size(); ++i) {
    Camera camera = around[i];
    if (i % 2 == 1)
      camera.view_from_world *= at_origin((camera.eye() - subject.center()) * (1 - near_distance));
    views.push_back(std::move(camera));
  }
  return views;
}

}  // namespace tureen
