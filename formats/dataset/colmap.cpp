#include "formats/dataset/colmap.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "formats/dataset/colmap_records.hpp"
#include "image/png.hpp"

namespace tureen {

namespace {

constexpr std::array<ColmapLensModel, 11> lens_models{{
    {"SIMPLE_PINHOLE", 3, true},         // f, cx, cy
    {"PINHOLE", 4, true},                // fx, fy, cx, cy
    {"SIMPLE_RADIAL", 4, true},          // f, cx, cy, k1
    {"RADIAL", 5, true},                 // f, cx, cy, k1, k2
    {"OPENCV", 8, true},                 // fx, fy, cx, cy, k1, k2, p1, p2
    {"OPENCV_FISHEYE", 8, true},         // fx, fy, cx, cy, k1, k2, k3, k4
    {"FULL_OPENCV", 12, false},          //
    {"FOV", 5, false},                   //
    {"SIMPLE_RADIAL_FISHEYE", 4, true},  // f, cx, cy, k1
    {"RADIAL_FISHEYE", 5, true},         // f, cx, cy, k1, k2
    {"THIN_PRISM_FISHEYE", 12, false},
}};

bool all_finite(std::span<const double> numbers) {
  for (const double number : numbers)
    if (!std::isfinite(number)) return false;
  return true;
}

int side(std::uint64_t value) {
  if (value < 1 || value > std::uint64_t(max_image_side))
    throw ColmapRefusal{"an image side of " + std::to_string(value) + " pixels is outside 1.." +
                        std::to_string(max_image_side)};
  return int(value);
}

/// The binary file if it exists, otherwise the text file, which may be missing.
struct ModelFile {
  std::filesystem::path path;
  bool binary = false;
  bool exists = false;
};

ModelFile model_file(const std::filesystem::path& folder, const std::string& name) {
  std::error_code ignored;
  const std::filesystem::path binary = folder / (name + ".bin"), text = folder / (name + ".txt");
  if (std::filesystem::exists(binary, ignored)) return {binary, true, true};
  return {text, false, std::filesystem::exists(text, ignored)};
}

}  // namespace

std::span<const ColmapLensModel> colmap_lens_models() { return lens_models; }

void require_undoable(const ColmapLensModel& model) {
  if (model.can_be_undone) return;
  std::string read;
  for (const ColmapLensModel& other : lens_models)
    if (other.can_be_undone) read += (read.empty() ? "" : ", ") + std::string(other.name);
  throw ColmapRefusal{
      "the camera model " + std::string(model.name) + " is not supported (supported: " + read + ")",
      "undistort the images first, with colmap image_undistorter"};
}

ColmapCamera to_camera(const ColmapCameraRecord& record) {
  require_undoable(*record.model);
  const std::vector<double>& p = record.parameters;
  if (!all_finite(p)) throw ColmapRefusal{"a camera's number is not finite"};
  ColmapCamera result;
  Camera& camera = result.pinhole;
  camera.width = side(record.width);
  camera.height = side(record.height);
  // PINHOLE, OPENCV and OPENCV_FISHEYE begin with two focal lengths, the others with one.
  const std::string_view name = record.model->name;
  const std::size_t focal_lengths =
      name == "PINHOLE" || name == "OPENCV" || name == "OPENCV_FISHEYE" ? 2 : 1;
  camera.fx = p[0];
  camera.fy = p[focal_lengths - 1];
  if (!(camera.fx > 0 && camera.fy > 0)) throw ColmapRefusal{"a focal length is not positive"};
  camera.cx = p[focal_lengths];
  camera.cy = p[focal_lengths + 1];
  Lens& lens = result.lens;
  if (name.ends_with("_FISHEYE")) lens.model = LensModel::fisheye;
  const bool fisheye = lens.model == LensModel::fisheye;
  double* const coefficients[] = {&lens.k1, &lens.k2, fisheye ? &lens.k3 : &lens.p1,
                                  fisheye ? &lens.k4 : &lens.p2};
  for (std::size_t i = focal_lengths + 2; i < p.size(); ++i)
    *coefficients[i - focal_lengths - 2] = p[i];
  return result;
}

glm::dmat4 to_view_from_world(const ColmapPoseRecord& record) {
  const auto& [w, x, y, z] = record.rotation;
  const double length = std::sqrt(w * w + x * x + y * y + z * z);
  // COLMAP writes normalised quaternions with 6 digits or more. An infinity or NaN fails, too.
  if (!(std::abs(length - 1) < 1e-3))
    throw ColmapRefusal{"the pose is not a rotation: its quaternion is not of unit length"};
  const auto& [tx, ty, tz] = record.translation;
  if (!all_finite(record.translation)) throw ColmapRefusal{"the pose is not finite"};
  glm::dmat4 camera_from_world =
      glm::dmat4(glm::mat3_cast(glm::dquat(w / length, x / length, y / length, z / length)));
  camera_from_world[3] = glm::dvec4(tx, ty, tz, 1);
  // COLMAP's cameras have y down and look along +z, ours have y up and look along -z.
  glm::dmat4 view_from_camera(1.0);
  view_from_camera[1][1] = view_from_camera[2][2] = -1;
  return view_from_camera * camera_from_world;
}

DatasetPoint to_point(glm::dvec3 position, glm::u8vec3 color) {
  if (!all_finite(std::array{position.x, position.y, position.z}))
    throw ColmapRefusal{"a point's position is not finite"};
  return {position, color};
}

std::optional<std::filesystem::path> colmap_folder(const std::filesystem::path& dataset) {
  for (const char* name : {"sparse/0", "sparse", "colmap/sparse/0"})
    if (model_file(dataset / name, "cameras").exists) return dataset / name;
  return {};
}

bool is_colmap_model(const std::filesystem::path& folder) {
  return model_file(folder, "cameras").exists && model_file(folder, "images").exists;
}

ColmapModel read_colmap_poses(const std::filesystem::path& folder, const MemoryBudget& budget) {
  ColmapModel model;
  const ModelFile cameras = model_file(folder, "cameras");
  Input camera_input = Input::open(cameras.path, budget);
  model.cameras = cameras.binary ? read_colmap_cameras_binary(camera_input)
                                 : read_colmap_cameras_text(camera_input);
  const ModelFile images = model_file(folder, "images");
  Input image_input = Input::open(images.path, budget);
  model.images =
      images.binary ? read_colmap_images_binary(image_input) : read_colmap_images_text(image_input);
  for (const ColmapImage& image : model.images)
    if (!model.cameras.contains(image.camera))
      throw InputError({image_input.name()}, "the image " + image.name + " was taken by camera " +
                                                 std::to_string(image.camera) + ", which " +
                                                 camera_input.name() + " does not have");
  return model;
}

std::vector<DatasetPoint> read_colmap_points(const std::filesystem::path& folder,
                                             const MemoryBudget& budget) {
  const ModelFile points = model_file(folder, "points3D");
  if (!points.exists) return {};
  Input input = Input::open(points.path, budget);
  return points.binary ? read_colmap_points_binary(input) : read_colmap_points_text(input);
}

ColmapModel read_colmap(const std::filesystem::path& folder, const MemoryBudget& budget) {
  ColmapModel model = read_colmap_poses(folder, budget);
  model.points = read_colmap_points(folder, budget);
  return model;
}

}  // namespace tureen
