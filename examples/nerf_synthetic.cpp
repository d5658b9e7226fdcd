#include "examples/nerf_synthetic.hpp"

#include <cassert>
#include <cmath>
#include <glm/matrix.hpp>
#include <nlohmann/json.hpp>

#include "base/output.hpp"

namespace tureen::example {

Camera with_z_up(Camera camera) {
  // Columns: the images of x, y and z.
  const glm::dmat4 y_up_from_z_up(1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1);
  camera.view_from_world = camera.view_from_world * y_up_from_z_up;
  return camera;
}

void write_transforms(const std::filesystem::path& folder, const std::string& split,
                      std::span<const Camera> cameras) {
  assert(!cameras.empty());
  nlohmann::ordered_json json;
  json["camera_angle_x"] = 2 * std::atan(0.5 * cameras[0].width / cameras[0].fx);
  for (const Camera& camera : cameras) {
    assert(!camera.name.empty());
    assert(camera.fx == camera.fy && camera.cx == 0.5 * camera.width &&
           camera.cy == 0.5 * camera.height &&
           camera.fx * cameras[0].width == cameras[0].fx * camera.width);
    const glm::dmat4 pose = glm::inverse(with_z_up(camera).view_from_world);
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (int row = 0; row < 4; ++row)
      rows.push_back({pose[0][row], pose[1][row], pose[2][row], pose[3][row]});
    json["frames"].push_back(
        {{"file_path", "./" + split + "/" + camera.name}, {"transform_matrix", rows}});
  }
  Output output(folder / ("transforms_" + split + ".json"));
  output.write(json.dump(1) + "\n");
  output.commit();
}

}  // namespace tureen::example
