// COLMAP's records as they stand in its files, text and binary alike, and what they mean to us.
// Include it in sources only.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/dataset/colmap.hpp"

namespace tureen {

/// A camera model of which we know the name and how many numbers it has.
struct ColmapLensModel {
  std::string_view name;
  std::size_t parameters;
  bool can_be_undone;
};

/// COLMAP's models, in the order of the numbers that stand for them in binary files.
std::span<const ColmapLensModel> colmap_lens_models();

/// A camera as a node of ColmapCameras.
inline constexpr std::size_t colmap_camera_bytes = sizeof(ColmapCameras::value_type) + 64;

struct ColmapCameraRecord {
  const ColmapLensModel* model = nullptr;
  std::uint64_t width = 0, height = 0;
  std::vector<double> parameters;  // model->parameters of them
};

struct ColmapPoseRecord {
  std::array<double, 4> rotation{};     // from world to camera, a quaternion w x y z
  std::array<double, 3> translation{};  // likewise
};

/// Why a record is refused; the reader knows which place to name.
struct ColmapRefusal {
  std::string reason;
  std::string hint = {};
};

/// Throws ColmapRefusal where the model is none that can be undone.
void require_undoable(const ColmapLensModel& model);

/// Throws ColmapRefusal: sides or focal lengths out of range, numbers that are not finite.
ColmapCamera to_camera(const ColmapCameraRecord& record);

/// In the OpenGL convention. Throws ColmapRefusal where the quaternion is not of unit length to
/// three digits.
glm::dmat4 to_view_from_world(const ColmapPoseRecord& record);

/// Throws ColmapRefusal where the position is not finite.
DatasetPoint to_point(glm::dvec3 position, glm::u8vec3 color);

}  // namespace tureen
