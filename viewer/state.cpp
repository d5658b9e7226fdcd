#include "viewer/state.hpp"

namespace tureen::viewer {

std::vector<const Camera*> State::recorded_cameras() const {
  std::vector<const Camera*> cameras;
  if (photographs)
    for (const Photograph& photograph : photographs->list) cameras.push_back(&photograph.camera);
  else if (stage)
    for (const Camera& camera : stage->scene->cameras) cameras.push_back(&camera);
  return cameras;
}

CameraKeyframe State::keyframe_of_now(double seconds) const {
  return {.camera = controls.camera(pixels.x, pixels.y),
          .seconds = seconds,
          .target_distance = controls.distance()};
}

const Photograph* State::photograph() const {
  if (!photographs || recorded < 0 || recorded >= static_cast<int>(photographs->list.size()))
    return nullptr;
  return controls.shows_adopted() ? &photographs->list[static_cast<std::size_t>(recorded)]
                                  : nullptr;
}

}  // namespace tureen::viewer
