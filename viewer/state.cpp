#include "viewer/state.hpp"

namespace tureen::viewer {

std::filesystem::path State::folder_of_images() const {
  std::filesystem::path folder = images_option;
  if (folder.empty()) folder = settings.images;
  if (folder.empty()) folder = images_folder();
  std::error_code unknown;
  return std::filesystem::absolute(folder, unknown).lexically_normal();
}

std::vector<const Camera*> State::recorded_cameras() const {
  std::vector<const Camera*> cameras;
  if (photographs)
    for (const Photograph& photograph : photographs->list) cameras.push_back(&photograph.camera);
  else if (stage)
    for (const Camera& camera : source.scene->cameras) cameras.push_back(&camera);
  return cameras;
}

const DocumentLayer& State::selected_layer() const {
  const DocumentLayer* const layer = find_layer(source.document, layer_editing.selected);
  return layer ? *layer : source.document.layers.front();
}

SceneSource State::drawn_source() const {
  SceneSource result = source;
  for (const RefusedLayer& refused : stage->refused)
    std::erase_if(result.document.layers,
                  [&](const DocumentLayer& layer) { return layer.id == refused.layer.id; });
  return result;
}

CameraKeyframe State::keyframe_of_now(double seconds) const {
  return controls.keyframe(pixels.x, pixels.y, seconds);
}

const Photograph* State::photograph() const {
  if (!photographs || recorded < 0 || recorded >= static_cast<int>(photographs->list.size()))
    return nullptr;
  const Photograph& photograph = photographs->list[static_cast<std::size_t>(recorded)];
  // The adopted view may be another camera: that of a keyframe, or the first view.
  const Camera shown = controls.camera(photograph.camera.width, photograph.camera.height);
  const bool same = controls.shows_adopted() &&
                    shown.view_from_world == photograph.camera.view_from_world &&
                    shown.fx == photograph.camera.fx && shown.cx == photograph.camera.cx &&
                    shown.cy == photograph.camera.cy;
  return same ? &photograph : nullptr;
}

}  // namespace tureen::viewer
