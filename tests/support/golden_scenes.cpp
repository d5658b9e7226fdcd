#include "tests/support/golden_scenes.hpp"

#include <utility>

namespace tureen::test {

Scene golden_scene(Kind kind) {
  Scene scene = scene_of(random_soup(2026, {.kind = kind, .faces = 150, .size = 0.25}));
  Random random(11);
  scene.cameras.push_back(random_camera(random, 320, 240));
  scene.info.name = to_string(kind);
  scene.info.background = {0.95f, 0.95f, 0.9f};
  return scene;
}

Scene golden_debug_view_scene(Scene example) {
  Camera camera = resized(example.cameras.at(golden_example_camera), 160, 120);
  camera.fx *= 6;
  camera.fy *= 6;
  example.cameras = {std::move(camera)};
  example.info.background = glm::vec3(0.0f);
  return example;
}

}  // namespace tureen::test
