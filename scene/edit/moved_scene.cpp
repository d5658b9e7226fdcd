#include "scene/edit/moved_scene.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "scene/scene_remarks.hpp"
#include "scene/similarity.hpp"

namespace tureen {

namespace {

void move_camera(Camera& camera, const glm::dmat4& world_from_world) {
  glm::dmat3 turn(world_from_world);
  const double scale = std::cbrt(std::abs(glm::determinant(turn)));
  for (int column = 0; column < 3; ++column) turn[column] /= scale;
  glm::dmat3 axes = turn * camera.world_from_view_rotation();
  // A mirrored camera would be left-handed.
  if (glm::determinant(turn) < 0) axes[0] = -axes[0];
  const glm::dvec3 eye(world_from_world * glm::dvec4(camera.eye(), 1.0));
  const glm::dmat3 rotation = glm::transpose(axes);
  camera.view_from_world = glm::dmat4(rotation);
  camera.view_from_world[3] = glm::dvec4(-(rotation * eye), 1.0);
}

}  // namespace

void move_scene(Scene& scene, const glm::dmat4& world_from_world) {
  for (Layer& layer : scene.layers)
    layer.world_from_layer = world_from_world * layer.world_from_layer;
  for (Camera& camera : scene.cameras) move_camera(camera, world_from_world);
  if (scene.first_view) move_camera(*scene.first_view, world_from_world);
}

void turn_upright(Scene& scene, const glm::vec3& up) {
  const glm::dvec3 from = glm::normalize(glm::dvec3(scene.info.up)),
                   to = glm::normalize(glm::dvec3(up));
  if (!(glm::distance(from, to) > 1e-6)) return;
  move_scene(scene, glm::dmat4(rotation_between(from, to)));
  choose_up(scene.info, up);
  scene.info.remarks.push_back(
      {&remarks::turned_upright, {{"from", axis_name(from)}, {"to", axis_name(to)}}});
}

}  // namespace tureen
