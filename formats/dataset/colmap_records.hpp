// COLMAP's records as stored in its files, text and binary, and their conversion. Include it only
// in sources.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/dataset/colmap.hpp"

namespace tureen {

/// A known camera model: its name and number of parameters.
struct ColmapLensModel {
  std::string_view name;
  std::size_t parameters;
  bool can_be_undone;
};

/// COLMAP's models, in the order of their ids in binary files.
std::span<const ColmapLensModel> colmap_lens_models();

/// Memory of a node of ColmapCameras, in bytes.
inline constexpr std::size_t colmap_camera_bytes = sizeof(ColmapCameras::value_type) + 64;

struct ColmapCameraRecord {
  const ColmapLensModel* model = nullptr;
  std::uint64_t width = 0, height = 0;
  std::vector<double> parameters;  // model->parameters values
};

struct ColmapPoseRecord {
  std::array<double, 4> rotation{};     // from world to camera, a quaternion w x y z
  std::array<double, 3> translation{};  // from world to camera
};

/// The reason why a record is rejected; the reader adds the place.
struct ColmapRefusal {
  std::string reason;
  std::string hint = {};
};

/// Throws ColmapRefusal if the model's distortion cannot be undone.
void require_undoable(const ColmapLensModel& model);

/// Throws ColmapRefusal for sides or focal lengths out of range and non-finite numbers.
ColmapCamera to_camera(const ColmapCameraRecord& record);

/// The pose in the OpenGL convention. Throws ColmapRefusal if the quaternion is not of unit length
/// to three digits.
glm::dmat4 to_view_from_world(const ColmapPoseRecord& record);

/// Throws ColmapRefusal if the position is not finite.
DatasetPoint to_point(glm::dvec3 position, glm::u8vec3 color);

}  // namespace tureen
