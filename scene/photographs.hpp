// Posed photographs: training data, and the reference in an evaluation.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "image/stored_image.hpp"
#include "scene/camera.hpp"
#include "scene/remark.hpp"

namespace tureen {

/// One photograph. Its camera is a pinhole in the OpenGL convention at the image's own size;
/// `camera.name` is the name in the dataset. World coordinates are those of the dataset.
///
/// Lens distortion has been removed by resampling (formats/dataset/lens.hpp). Focal lengths are
/// unchanged. Border rows and columns that the photograph does not fill are cropped, and the
/// principal point is shifted accordingly. Alpha below 255 therefore always comes from the dataset.
struct Photograph {
  Camera camera;
  StoredImage image;  // straight alpha; camera.width x camera.height
  /// One per pixel, in the image's order, 1 for pixels that a mask of the dataset excludes from
  /// training and evaluation; empty if no pixel is excluded.
  StoredBytes ignored = {};

  /// Moves the pixels to the file, unless they are in one. Throws OutputError if the disk is full.
  void move_to(const std::shared_ptr<ScratchFile>& file) {
    image.move_to(file);
    ignored.move_to(file);
  }
  /// The file that has the pixels; null if they are in memory.
  const std::shared_ptr<ScratchFile>& file() const { return image.planes().file(); }
  /// Of the pixels, in memory or in the file.
  std::uint64_t bytes() const {
    return ignored.size() + (file() ? image.planes().size() : sizeof(glm::u8vec4) * image.pixels());
  }
};

struct DatasetPoint {
  glm::dvec3 position;
  glm::u8vec3 color;
};

struct Dataset {
  std::vector<Photograph> train;
  std::vector<Photograph> test;
  std::vector<DatasetPoint> points;  // from structure from motion; may be empty
  /// Most likely up axis: z for transforms.json, as in the scenes of NeRF and instant-ngp; the mean
  /// of the cameras' up axes for COLMAP and Bundler.
  glm::vec3 up{0.0f, 1.0f, 0.0f};
  bool has_alpha = false;       // whether any photograph has transparent pixels
  std::vector<Remark> remarks;  // assumptions and corrections of the reader
};

}  // namespace tureen
