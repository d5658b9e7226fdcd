#include "formats/dataset/colmap.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "formats/dataset/colmap_records.hpp"
#include "image/png.hpp"

namespace tureen {

namespace {

/// The simpler models have the first coefficients of another one, and the others are 0.
constexpr std::array<ColmapLensModel, 18> lens_models{{
    {"SIMPLE_PINHOLE", 1, 0, nullptr},
    {"PINHOLE", 2, 0, nullptr},
    {"SIMPLE_RADIAL", 1, 1, &brown_model},
    {"RADIAL", 1, 2, &brown_model},
    {"OPENCV", 2, 4, &brown_model},
    {"OPENCV_FISHEYE", 2, 4, &fisheye_model},
    {"FULL_OPENCV", 2, 8, &brown_model},
    {"FOV", 2, 1, &fov_model},
    {"SIMPLE_RADIAL_FISHEYE", 1, 1, &fisheye_model},
    {"RADIAL_FISHEYE", 1, 2, &fisheye_model},
    {"THIN_PRISM_FISHEYE", 2, 8, &thin_prism_model},
    {"RAD_TAN_THIN_PRISM_FISHEYE", 2, 12, &rad_tan_thin_prism_model},
    {"SIMPLE_DIVISION", 1, 1, &division_model},
    {"DIVISION", 2, 1, &division_model},
    {"SIMPLE_FISHEYE", 1, 0, &fisheye_model},
    {"FISHEYE", 2, 0, &fisheye_model},
    {"EUCM", 2, 2, &eucm_model},
    {"EQUIRECTANGULAR", 0, 0, nullptr},
}};

bool all_finite(std::span<const double> numbers) {
  for (const double number : numbers)
    if (!std::isfinite(number)) return false;
  return true;
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

std::string unsupported_model(const std::string& name) {
  std::string read;
  for (const ColmapLensModel& other : lens_models)
    read += (read.empty() ? "" : ", ") + std::string(other.name);
  return "the camera model " + name.substr(0, 40) + " is not supported (supported: " + read +
         "); undistort the images first, with colmap image_undistorter";
}

ColmapCamera to_camera(const ColmapCameraRecord& record) {
  const std::vector<double>& p = record.parameters;
  const auto defective = [](std::string defect) {
    return ColmapCamera{.defect = std::move(defect)};
  };
  if (!all_finite(p)) return defective("a number of its camera is not finite");
  for (const std::uint64_t side : {record.width, record.height})
    if (side < 1 || side > std::uint64_t(max_image_side))
      return defective("its camera has a side of " + std::to_string(side) +
                       " pixels, which is outside 1.." + std::to_string(max_image_side));
  ColmapCamera result;
  Camera& camera = result.pinhole;
  camera.width = int(record.width);
  camera.height = int(record.height);
  result.is_panorama = record.model->is_panorama();
  if (result.is_panorama) return result;
  const std::size_t focal_lengths = record.model->focal_lengths;
  camera.fx = p[0];
  camera.fy = p[focal_lengths - 1];
  if (!(camera.fx > 0 && camera.fy > 0))
    return defective("a focal length of its camera is not positive");
  camera.cx = p[focal_lengths];
  camera.cy = p[focal_lengths + 1];
  if (record.model->lens)
    result.lens = lens_of(*record.model->lens, std::span(p).subspan(focal_lengths + 2));
  return result;
}

void set_pose(ColmapImage& image, const ColmapPoseRecord& record) {
  const auto& [w, x, y, z] = record.rotation;
  const double length = std::sqrt(w * w + x * x + y * y + z * z);
  const auto& [tx, ty, tz] = record.translation;
  // COLMAP writes normalised quaternions with 6 digits or more.
  if (!all_finite(record.rotation) || !all_finite(record.translation)) {
    image.defect = "its pose is not finite";
  } else if (!(std::abs(length - 1) < 1e-3)) {
    image.defect = "its pose is not a rotation: the quaternion is not of unit length";
  } else {
    glm::dmat4 camera_from_world =
        glm::dmat4(glm::mat3_cast(glm::dquat(w / length, x / length, y / length, z / length)));
    camera_from_world[3] = glm::dvec4(tx, ty, tz, 1);
    // COLMAP's cameras have y down and look along +z, ours have y up and look along -z.
    glm::dmat4 view_from_camera(1.0);
    view_from_camera[1][1] = view_from_camera[2][2] = -1;
    image.view_from_world = view_from_camera * camera_from_world;
  }
}

void add_point(ColmapPoints& points, glm::dvec3 position, glm::u8vec3 color) {
  if (all_finite(std::array{position.x, position.y, position.z}))
    points.points.push_back({position, color});
  else
    ++points.skipped;
}

constexpr const char* colmap_places[] = {"sparse", "colmap/sparse", "undistorted/sparse",
                                         "dense/sparse", "dense/0/sparse"};

std::vector<std::filesystem::path> colmap_folders(const std::filesystem::path& dataset) {
  namespace fs = std::filesystem;
  for (const char* name : colmap_places) {
    std::vector<std::pair<int, fs::path>> numbered;
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(dataset / name, ignored)) {
      const std::string text = entry.path().filename().string();
      int number = 0;
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
      if (error == std::errc() && end == text.data() + text.size() &&
          model_file(entry.path(), "cameras").exists)
        numbered.push_back({number, entry.path()});
    }
    std::ranges::sort(numbered);
    std::vector<fs::path> folders;
    for (auto& [number, path] : numbered) folders.push_back(std::move(path));
    if (folders.empty() && model_file(dataset / name, "cameras").exists)
      folders.push_back(dataset / name);
    if (!folders.empty()) return folders;
  }
  if (is_colmap_model(dataset)) return {dataset};
  return {};
}

std::size_t usable_images(const ColmapModel& model) {
  return std::size_t(std::ranges::count_if(
      model.images, [](const ColmapImage& image) { return image.defect.empty(); }));
}

std::filesystem::path largest_model(const std::vector<std::filesystem::path>& folders,
                                    const MemoryBudget& budget) {
  if (folders.size() == 1) return folders.front();
  std::size_t most = 0, best = 0;
  for (std::size_t i = 0; i < folders.size(); ++i)
    if (const std::size_t usable = usable_images(read_colmap_poses(folders[i], budget));
        usable > most) {
      most = usable;
      best = i;
    }
  return folders[best];
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
  for (ColmapImage& image : model.images) {
    const auto camera = model.cameras.find(image.camera);
    if (!image.defect.empty()) continue;
    image.defect = camera != model.cameras.end()
                       ? camera->second.defect
                       : "its camera " + std::to_string(image.camera) + " is missing";
  }
  return model;
}

ColmapPoints read_colmap_points(const std::filesystem::path& folder, const MemoryBudget& budget) {
  const ModelFile points = model_file(folder, "points3D");
  if (!points.exists) return {};
  Input input = Input::open(points.path, budget);
  return points.binary ? read_colmap_points_binary(input) : read_colmap_points_text(input);
}

std::vector<ColmapTrack> read_colmap_tracks(const std::filesystem::path& folder,
                                            const MemoryBudget& budget) {
  Input input = Input::open(folder / "points3D.bin", budget);
  return read_colmap_tracks_binary(input);
}

ColmapModel read_colmap(const std::filesystem::path& folder, const MemoryBudget& budget) {
  ColmapModel model = read_colmap_poses(folder, budget);
  model.points = read_colmap_points(folder, budget);
  return model;
}

}  // namespace tureen
