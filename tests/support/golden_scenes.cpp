#include "tests/support/golden_scenes.hpp"

#include <glm/gtc/matrix_transform.hpp>
#include <utility>

#include "tests/support/random_splats.hpp"

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

Scene layered_scene(std::uint64_t seed) {
  Random random(seed + 100);
  const auto soup = [&](Kind kind, int level) {
    return random_soup(seed * 10 + std::uint64_t(level),
                       {.kind = kind, .faces = 60, .size = 0.5, .level = level});
  };
  const glm::dmat4 turned = glm::translate(glm::dmat4(1.0), {0.3, -0.2, 0.1}) *
                            glm::rotate(glm::dmat4(1.0), 1.1, glm::dvec3(0.6, 0.0, 0.8)) *
                            glm::scale(glm::dmat4(1.0), glm::dvec3(-0.7, 0.7, 0.7));
  Scene scene;
  scene.layers.push_back({.name = "first", .primitives = soup(Kind::lattice_mlp, 3)});
  scene.layers.push_back({.name = "mesh",
                          .world_from_layer = at_origin({-0.2, 0.1, 0.3}),
                          .primitives = soup(Kind::uv_textures, 0)});
  scene.layers.push_back(
      {.name = "turned", .world_from_layer = turned, .primitives = soup(Kind::lattice_mlp, 1)});
  scene.cameras.push_back(random_camera(random, 320, 240));
  scene.info.name = "layers";
  scene.info.background = {0.95f, 0.95f, 0.9f};
  return scene;
}

Scene golden_splats() {
  Scene scene = scene_of(random_soup(12, {.kind = Kind::face_colors, .faces = 60, .size = 0.6}));
  scene.layers[0].name = "soup";
  // Triangle windows, Gaussians, discs and neural densities.
  for (const int kind : {0, 1, 4, 6}) {
    const std::size_t place = scene.layers.size() - 1;
    const glm::dvec3 at(place % 2 == 0 ? -1.1 : 1.1, place < 2 ? 0.9 : -0.9, 0.3);
    scene.layers.push_back({.name = splat_kinds[kind].name,
                            .world_from_layer = at_origin(at),
                            .primitives = random_splats(splat_kinds[kind], 300, 0.15, 13)});
  }
  scene.cameras.push_back(look_at({0.4, 0.6, 6}, {0, 0, 0}, {0, 1, 0}, 0.7, 320, 240));
  scene.info.name = "splats";
  scene.info.background = {0.95f, 0.95f, 0.9f};
  return scene;
}

Scene golden_layers(Scene scene) {
  const glm::dvec3 above(-0.9, 0.9, 2.0);
  const glm::dmat4 turned = glm::translate(glm::dmat4(1.0), above) *
                            glm::rotate(glm::dmat4(1.0), 0.5, glm::dvec3(0.6, 0.0, 0.8)) *
                            glm::scale(glm::dmat4(1.0), glm::dvec3(-0.6, 0.6, 0.6)) *
                            scene.layers[0].world_from_layer;
  const glm::dmat4 beside =
      glm::scale(glm::translate(glm::dmat4(1.0), glm::dvec3(1.2, -1.2, 1.0)), glm::dvec3(0.5));
  scene.layers.push_back({.name = "mesh",
                          .world_from_layer = beside,
                          .primitives = random_soup(3, {.kind = Kind::uv_textures, .faces = 40})});
  Layer copy = scene.layers[0];
  copy.world_from_layer = turned;
  scene.layers.push_back(std::move(copy));
  scene.cameras = {resized(scene.cameras.at(golden_example_camera), 320, 240)};
  return scene;
}

}  // namespace tureen::test
