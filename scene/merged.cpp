// One scene from several.
#include <algorithm>
#include <cassert>
#include <set>
#include <utility>

#include "base/error.hpp"
#include "scene/edit/moved_scene.hpp"
#include "scene/scene.hpp"
#include "scene/scene_remarks.hpp"

namespace tureen {

namespace {

/// Appends a number to each name that was taken before.
class DistinctNames {
 public:
  std::string take(const std::string& name) {
    std::string result = name;
    for (int number = 2; !taken_.insert(result).second; ++number)
      result = name + " " + std::to_string(number);
    return result;
  }

 private:
  std::set<std::string> taken_;
};

/// Names of the settings of `scene` that merged() drops.
std::vector<std::string> dropped_settings(const Scene& scene, const Scene& first) {
  std::vector<std::string> names;
  if (!scene.cameras.empty() && scene.cameras != first.cameras) names.emplace_back("cameras");
  if (scene.info.up != first.info.up) names.emplace_back("up axis");
  if (scene.info.background != first.info.background) names.emplace_back("background");
  if (scene.quality != first.quality) names.emplace_back("quality");
  return names;
}

void require_few_layers(const std::vector<Scene>& scenes) {
  std::size_t layers = 0;
  for (const Scene& scene : scenes) layers += scene.layers.size();
  if (layers > max_layers)
    throw UsageError("these scenes have " + std::to_string(layers) +
                     " layers together; a scene has at most " + std::to_string(max_layers));
}

/// Adds the layers, remarks and notes of `scene` to the result; `name` is the scene's own.
void add(Scene&& scene, const std::string& name, DistinctNames& layer_names, Scene& result) {
  const bool several = scene.layers.size() > 1;
  for (Layer& layer : scene.layers) {
    layer.name = layer_names.take(layer.name.empty() ? name : layer.name);
    result.layers.push_back(std::move(layer));
  }
  for (Remark& remark : scene.info.remarks) {
    if (remark.scene.empty()) remark.scene = name;
    result.info.remarks.push_back(std::move(remark));
  }
  // The notes of a scene with several layers have names from an earlier merged(). A second name in
  // front would grow with each merge, and equal notes would repeat.
  std::vector<std::string>& notes = result.info.notes;
  for (const std::string& note : scene.info.notes) {
    std::string text = several ? note : name + ": " + note;
    if (std::find(notes.begin(), notes.end(), text) == notes.end())
      notes.push_back(std::move(text));
  }
}

}  // namespace

Scene merged(std::vector<Scene> scenes, UpAxes differing) {
  assert(!scenes.empty());
  require_few_layers(scenes);
  if (scenes.size() == 1) return std::move(scenes.front());

  Scene result;
  const Scene& first = scenes.front();
  result.cameras = first.cameras;
  result.first_view = first.first_view;
  result.quality = first.quality;
  result.info = first.info;
  result.info.remarks.clear();
  result.info.notes.clear();
  DistinctNames scene_names, layer_names;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    Scene& scene = scenes[i];
    const std::string name = scene_names.take(scene.info.name.empty() ? "scene" : scene.info.name);
    if (scene.info.compressed) result.info.compressed = true;
    if (differing == UpAxes::turn) turn_upright(scene, result.info.up);
    if (i > 0)
      if (auto dropped = dropped_settings(scene, result); !dropped.empty())
        scene.info.remarks.push_back(
            {&remarks::settings_dropped, {{"settings", std::move(dropped)}}});
    add(std::move(scene), name, layer_names, result);
  }
  return result;
}

}  // namespace tureen
