// A photograph of a dataset before it is read: what every kind of dataset says of one.
#pragma once

#include <filesystem>
#include <functional>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <optional>
#include <string>

#include "formats/dataset/lens.hpp"
#include "scene/camera.hpp"

namespace tureen {

struct DatasetFrame {
  std::string name;              // in the dataset, as its file spells it: what frames are sorted by
  std::filesystem::path folder;  // nothing outside of it is opened
  std::string file;              // below `folder`; may lack its extension
  /// Of the picture in the folder of full-sized images, where the dataset says it.
  std::optional<glm::ivec2> size;
  /// The camera where the full-sized picture has this width and height: `size` where it is known.
  std::function<Camera(int width, int height)> camera;
  Lens lens;
  glm::dmat4 view_from_world{1.0};  // the camera's
};

}  // namespace tureen
