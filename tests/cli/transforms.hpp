// A dataset's transforms_SPLIT.json, assembled from cameras.
#pragma once

#include <glm/matrix.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "scene/camera.hpp"

namespace tureen::test {

/// The common part for photographs with these intrinsics, without frames.
inline nlohmann::json transforms_of(const Camera& camera) {
  return {{"fl_x", camera.fx},
          {"fl_y", camera.fy},
          {"cx", camera.cx},
          {"cy", camera.cy},
          {"w", camera.width},
          {"h", camera.height},
          {"frames", nlohmann::json::array()}};
}

/// A frame: the photograph `file` and its pose, row by row.
inline nlohmann::json frame_of(const std::string& file, const Camera& camera) {
  const glm::dmat4 world_from_view = glm::inverse(camera.view_from_world);
  nlohmann::json rows = nlohmann::json::array();
  for (int row = 0; row < 4; ++row)
    rows.push_back({world_from_view[0][row], world_from_view[1][row], world_from_view[2][row],
                    world_from_view[3][row]});
  return {{"file_path", file}, {"transform_matrix", rows}};
}

}  // namespace tureen::test
