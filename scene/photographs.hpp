// Posed photographs: what a trainer learns from, and the reference of an evaluation.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "image/image.hpp"
#include "scene/camera.hpp"
#include "scene/remark.hpp"

namespace tureen {

/// One photograph. Its camera is a pinhole in the OpenGL convention at the picture's own size, and
/// `camera.name` is the name in the dataset. World coordinates are the dataset's own.
///
/// Lens distortion has been undone by resampling (formats/dataset/lens.hpp). Focal lengths stay;
/// rows and columns at the border that the photograph does not fill are cut off, and the principal
/// point follows. So every pixel is evidence: nobody needs a mask, and alpha below 255 always means
/// what the dataset meant by it.
struct Photograph {
  Camera camera;
  Image8 image;  // straight alpha; camera.width x camera.height
};

struct DatasetPoint {
  glm::dvec3 position;
  glm::u8vec3 color;
};

struct Dataset {
  std::vector<Photograph> train;
  std::vector<Photograph> test;
  std::vector<DatasetPoint> points;  // of structure from motion; empty where there are none
  /// What is most likely up: z for transforms.json, as in the scenes of NeRF and instant-ngp; the
  /// mean of the cameras' up axes for COLMAP.
  glm::vec3 up{0.0f, 1.0f, 0.0f};
  bool has_alpha = false;       // some photograph is transparent somewhere
  std::vector<Remark> remarks;  // what was assumed or undone
};

}  // namespace tureen
