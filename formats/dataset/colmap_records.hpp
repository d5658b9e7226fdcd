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

/// A known camera model: the focal lengths (one or two) precede the principal point and the lens.
struct ColmapLensModel {
  std::string_view name;
  std::size_t focal_lengths;
  std::size_t coefficients;
  const LensModel* lens;  // null: none
  /// A panorama has no focal length and no principal point: its width and height again.
  bool is_panorama() const { return focal_lengths == 0; }
  std::size_t parameters() const { return focal_lengths + 2 + coefficients; }
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

/// ColmapCamera::defect of a model whose distortion cannot be undone; lists the supported ones.
std::string unsupported_model(const std::string& name);

/// A camera with numbers out of range has a defect.
ColmapCamera to_camera(const ColmapCameraRecord& record);

/// Sets the pose, in the OpenGL convention, or the defect: the quaternion is not of unit length to
/// three digits, or a number is not finite.
void set_pose(ColmapImage& image, const ColmapPoseRecord& record);

/// Counts a position that is not finite as skipped.
void add_point(ColmapPoints& points, glm::dvec3 position, glm::u8vec3 color);

}  // namespace tureen
