#include "formats/dataset/gaussian_cameras.hpp"

#include <nlohmann/json.hpp>

#include "formats/dataset/camera_json.hpp"

namespace tureen {

namespace {

Camera read_camera(const CameraJson& json) {
  Camera camera;
  camera.name = json.text("img_name");
  camera.width = json.side("width");
  camera.height = json.side("height");
  camera.fx = json.number("fx");
  camera.fy = json.number("fy");
  if (!(camera.fx > 0 && camera.fy > 0)) json.fail("a focal length is not positive");
  camera.cx = json.maybe_number("cx").value_or(0.5 * camera.width);
  camera.cy = json.maybe_number("cy").value_or(0.5 * camera.height);
  glm::dmat4 world_from_view(json.rotation("rotation"));
  world_from_view[1] *= -1.0;
  world_from_view[2] *= -1.0;
  world_from_view[3] = glm::dvec4(json.vector("position"), 1.0);
  camera.view_from_world = rigid_inverse(world_from_view);
  return camera;
}

}  // namespace

std::vector<Camera> read_gaussian_cameras(const nlohmann::json& list, const std::string& file) {
  std::vector<Camera> cameras;
  for (std::size_t i = 0; i < list.size(); ++i)
    cameras.push_back(read_camera(CameraJson(
        {.object = list[i], .file = file, .where = "camera " + std::to_string(i) + ": "})));
  return cameras;
}

}  // namespace tureen
