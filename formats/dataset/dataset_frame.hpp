// A photograph of a dataset before it is read, in a form shared by all kinds of dataset.
#pragma once

#include <filesystem>
#include <functional>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "formats/dataset/lens.hpp"
#include "formats/dataset/panorama.hpp"
#include "scene/camera.hpp"

namespace tureen {

struct DatasetFrame {
  std::string name;  // in the dataset, as spelled in its file; the sort key
  std::filesystem::path folder;
  std::string file;               // relative to `folder`; may lack its extension
  std::filesystem::path dataset;  // the folder that may have one of masks
  /// Size of the image in the folder of full-sized images, if the dataset stores it.
  std::optional<glm::ivec2> size;
  /// Without `size`: whether images may differ in size, because lengths are in pixels.
  bool any_size = false;
  /// The camera for a full-sized image with this width and height (`size` if known); of a face, for
  /// a full-sized photograph.
  std::function<Camera(int width, int height)> camera;
  Lens lens;
  const PanoramaFace* face = nullptr;  // of a photograph of the whole sphere
  /// The mask that the dataset names for the image, relative to `folder`; empty: none. Its black
  /// pixels are not used.
  std::string mask;
  glm::dmat4 view_from_world{1.0};  // the camera's
  std::string defect = {};          // why the photograph cannot be used; empty: it can
};

/// Adds six views of a photograph of the whole sphere: `frame`, which has the pose of its middle.
void add_faces(const DatasetFrame& frame, std::vector<DatasetFrame>& frames);

}  // namespace tureen
