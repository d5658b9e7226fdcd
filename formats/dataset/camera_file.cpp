#include "formats/dataset/camera_file.hpp"

#include <algorithm>
#include <cassert>
#include <cctype>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "formats/dataset/camera_json.hpp"
#ifndef __EMSCRIPTEN__  // its sources are omitted there, see CMakeLists.txt
#include "formats/dataset/colmap.hpp"
#endif
#include "base/json/json_file.hpp"
#include "formats/dataset/dataset_remarks.hpp"
#include "formats/dataset/skipped.hpp"
#include "formats/dataset/transforms_json.hpp"

namespace tureen {

namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

constexpr const char* whole_sphere = "a photograph of the whole sphere has no pinhole camera";

CameraFile from_transforms(const Json& root, const std::string& file) {
  // NeRF's synthetic scenes store no image size; their images have 800 x 800 pixels.
  constexpr int assumed_side = 800;
  CameraFile result;
  bool size_assumed = false, distorted = false;
  SkippedPhotographs skipped;
  for (const TransformsFrame& frame : read_transforms(root, file)) {
    if (!frame.defect.empty()) {
      skipped.add(frame.file_path, frame.defect);
      continue;
    }
    if (frame.is_panorama) {
      skipped.add(frame.file_path, whole_sphere);
      continue;
    }
    size_assumed = size_assumed || !frame.width || !frame.height;
    distorted = distorted || frame.is_distorted();
    result.cameras.push_back(
        pinhole(frame, frame.width.value_or(assumed_side), frame.height.value_or(assumed_side)));
  }
  skipped.require_enough(file, result.cameras.size(), false);
  skipped.add_remarks(result.remarks, result.cameras.size());
  if (size_assumed)
    result.remarks.push_back(
        {&remarks::image_size_missing, {{"width", assumed_side}, {"height", assumed_side}}});
  if (distorted) result.remarks.push_back({&remarks::lens_dropped});
  return result;
}

std::vector<CameraJson> elements(const Json& cameras, const std::string& file) {
  std::vector<CameraJson> result;
  for (std::size_t i = 0; i < cameras.size(); ++i)
    result.push_back(CameraJson(
        {.object = cameras[i], .file = file, .where = "camera " + std::to_string(i) + ": "}));
  return result;
}

Camera our_camera(const CameraJson& json) {
  Camera camera;
  camera.name = json.text("name");
  camera.width = json.side("width");
  camera.height = json.side("height");
  camera.fx = json.number("fx");
  camera.fy = json.number("fy");
  camera.cx = json.number("cx");
  camera.cy = json.number("cy");
  if (!(camera.fx > 0 && camera.fy > 0)) json.fail("a focal length is not positive");
  camera.view_from_world = json.rigid("view_from_world");
  return camera;
}

/// The cameras of a file in our own format, as JSON for our_camera.
std::vector<CameraJson> our_cameras(const Json& root, const std::string& file) {
  const auto version = root.find("tureen_cameras");
  if (version != root.end() && *version != 1)
    throw InputError({file}, "tureen_cameras is not version 1");
  return elements(json_list(root, "cameras", file), file);
}

CameraFile from_ours(const Json& root, const std::string& file) {
  CameraFile result;
  for (const CameraJson& json : our_cameras(root, file)) result.cameras.push_back(our_camera(json));
  return result;
}

Camera gaussian_camera(const CameraJson& json) {
  Camera camera;
  camera.name = json.text("img_name");
  camera.width = json.side("width");
  camera.height = json.side("height");
  camera.fx = json.number("fx");
  camera.fy = json.number("fy");
  if (!(camera.fx > 0 && camera.fy > 0)) json.fail("a focal length is not positive");
  camera.cx = json.maybe_number("cx").value_or(0.5 * camera.width);
  camera.cy = json.maybe_number("cy").value_or(0.5 * camera.height);
  glm::dmat4 world_from_view(json.rotation("rotation"));
  world_from_view[1] *= -1.0;
  world_from_view[2] *= -1.0;
  world_from_view[3] = glm::dvec4(json.vector("position"), 1.0);
  camera.view_from_world = rigid_inverse(world_from_view);
  return camera;
}

/// cameras.json as 3D Gaussian Splatting and its descendants write it beside a model:
///   [ { "id": 0, "img_name": "0001", "width": 640, "height": 360, "position": [3 numbers],
///       "rotation": [[3 numbers], [3 numbers], [3 numbers]], "fx": 500.0, "fy": 500.0 } ]
/// position is the eye in world coordinates. The columns of rotation are the camera's axes in the
/// world, in OpenCV's convention (x right, y down, looking along +z); the reader converts them to
/// OpenGL's.
///
/// The cameras in the list's order, each named by its img_name. Without cx, cy the principal point
/// is the centre: the format does not store it, but some descendants do. Throws InputError with the
/// camera and the reason.
std::vector<Camera> gaussian_cameras(const Json& list, const std::string& file) {
  std::vector<Camera> cameras;
  for (const CameraJson& json : elements(list, file)) cameras.push_back(gaussian_camera(json));
  return cameras;
}

// ---- Paths

// In seconds, more than eleven days: a larger value is probably in another unit. Doubles resolve a
// nanosecond up to here.
constexpr double longest_path = 1e6;

CameraKeyframe our_keyframe(const CameraJson& json) {
  CameraKeyframe keyframe{.camera = our_camera(json),
                          .seconds = json.number("seconds"),
                          .target_distance = json.maybe_number("target_distance").value_or(0)};
  if (!(keyframe.seconds >= 0 && keyframe.seconds <= longest_path))
    json.fail("seconds is not from 0 to 1000000");
  if (!(keyframe.target_distance >= 0 && std::isfinite(keyframe.target_distance)))
    json.fail("target_distance is negative");
  return keyframe;
}

/// Duration of the loop in seconds; 0 without a loop.
double our_loop(const Json& root, const std::vector<CameraKeyframe>& keyframes,
                const std::string& file) {
  const auto fail = [&](const char* reason) { throw InputError({file}, reason); };
  const auto loop = root.find("loop");
  if (loop == root.end()) return 0;
  if (!loop->is_boolean()) fail("loop is neither true nor false");
  if (!loop->get<bool>()) return 0;
  const auto seconds = root.find("loop_seconds");
  const double span = keyframes.back().seconds - keyframes.front().seconds;
  if (seconds == root.end()) {
    const double gaps = double(keyframes.size()) - 1;
    return span > 0 ? span + span / gaps : 1.0;
  }
  if (!seconds->is_number()) fail("loop_seconds is not a number");
  const double value = seconds->get<double>();
  if (!(value > 0 && value <= longest_path)) fail("loop_seconds is not above 0, up to 1000000");
  return value;
}

CameraPathData our_path(const Json& root, const std::string& file) {
  if (!root.is_object() || !root.contains("cameras"))
    throw InputError({file}, "it has no \"cameras\": not a camera path in our format");
  CameraPathData path;
  for (const CameraJson& json : our_cameras(root, file)) {
    path.keyframes.push_back(our_keyframe(json));
    const std::size_t count = path.keyframes.size();
    if (count > 1 && path.keyframes[count - 1].seconds < path.keyframes[count - 2].seconds)
      json.fail("seconds is less than that of the camera before it");
  }
  if (path.keyframes.empty()) throw InputError({file}, "it holds no cameras");
  path.loop_seconds = our_loop(root, path.keyframes, file);
  return path;
}

#ifndef __EMSCRIPTEN__
/// The folder of the COLMAP model at `path` (see read_cameras), or nullopt.
std::optional<fs::path> colmap_model(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) {
    if (is_colmap_model(path)) return path;
    if (const auto folders = colmap_folders(path); !folders.empty()) return largest_model(folders);
    return {};
  }
  const std::string name = path.filename().string();
  for (const char* file : {"cameras.bin", "cameras.txt", "images.bin", "images.txt"})
    if (name == file && is_colmap_model(path.parent_path())) return path.parent_path();
  return {};
}

CameraFile from_colmap(const fs::path& folder) {
  ColmapModel model = read_colmap_poses(folder);
  std::sort(model.images.begin(), model.images.end(),
            [](const ColmapImage& a, const ColmapImage& b) { return a.name < b.name; });
  CameraFile result;
  bool distorted = false;
  SkippedPhotographs skipped;
  for (const ColmapImage& image : model.images) {
    if (!image.defect.empty()) {
      skipped.add(image.name, image.defect);
      continue;
    }
    const ColmapCamera& taken_by = model.cameras.at(image.camera);
    if (taken_by.is_panorama) {
      skipped.add(image.name, whole_sphere);
      continue;
    }
    distorted = distorted || !taken_by.lens.is_pinhole();
    Camera& camera = result.cameras.emplace_back(taken_by.pinhole);
    camera.name = image.name;
    camera.view_from_world = image.view_from_world;
  }
  skipped.require_enough(folder.string(), result.cameras.size(), false);
  skipped.add_remarks(result.remarks, result.cameras.size());
  if (distorted) result.remarks.push_back({&remarks::lens_dropped});
  return result;
}
#else
std::optional<fs::path> colmap_model(const fs::path&) { return {}; }
CameraFile from_colmap(const fs::path&) { return {}; }
#endif

}  // namespace

bool is_camera_file(const fs::path& path) {
  if (colmap_model(path)) return true;
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return false;
  std::ifstream stream(path, std::ios::binary);
  char c = 0;
  while (stream.get(c) && std::isspace(static_cast<unsigned char>(c))) {
  }
  return c == '{' || c == '[';
}

CameraFile read_cameras(Input& input) {
  const Json root = read_json(input);
  const std::string& file = input.name();
  if (root.is_array()) return {gaussian_cameras(root, file), {}};
  if (!root.is_object()) throw InputError({file}, "the file holds no JSON object or list");
  if (root.contains("frames")) return from_transforms(root, file);
  if (root.contains("cameras")) return from_ours(root, file);
  throw InputError({file},
                   "it has neither \"cameras\" nor \"frames\": not a supported camera file");
}

CameraFile read_cameras(const std::filesystem::path& path) {
  if (const std::optional<fs::path> folder = colmap_model(path)) return from_colmap(*folder);
  Input input = Input::open(path);
  return read_cameras(input);
}

CameraPathData read_path(Input& input) { return our_path(read_json(input), input.name()); }

CameraPathData read_path(const std::filesystem::path& path) {
  Input input = Input::open(path);
  return read_path(input);
}

// ---- Writing

namespace {

using Ordered = nlohmann::ordered_json;

/// Adds the fields of a camera.
void put_camera(const Camera& camera, Ordered& json) {
  if (!camera.name.empty()) json["name"] = camera.name;
  json["width"] = camera.width;
  json["height"] = camera.height;
  json["fx"] = camera.fx;
  json["fy"] = camera.fy;
  json["cx"] = camera.cx;
  json["cy"] = camera.cy;
  Ordered rows = Ordered::array();
  for (int row = 0; row < 3; ++row) {
    Ordered columns = Ordered::array();
    for (int column = 0; column < 4; ++column)
      columns.push_back(camera.view_from_world[column][row]);
    rows.push_back(std::move(columns));
  }
  json["view_from_world"] = std::move(rows);
}

std::string text_of(const Ordered& root) {
  // Names may contain invalid UTF-8. Such bytes become U+FFFD; the default throws an exception.
  return root.dump(2, ' ', false, Ordered::error_handler_t::replace) + "\n";
}

}  // namespace

std::string cameras_to_json(std::span<const Camera> cameras) {
  Ordered list = Ordered::array();
  for (const Camera& camera : cameras) put_camera(camera, list.emplace_back(Ordered::object()));
  return text_of({{"tureen_cameras", 1}, {"cameras", std::move(list)}});
}

std::string path_to_json(const CameraPathData& path) {
  Ordered list = Ordered::array();
  [[maybe_unused]] double before = 0;
  for (const CameraKeyframe& keyframe : path.keyframes) {
    assert(keyframe.seconds >= before);
    before = keyframe.seconds;
    Ordered& json = list.emplace_back(Ordered::object());
    json["seconds"] = keyframe.seconds;
    if (keyframe.target_distance > 0) json["target_distance"] = keyframe.target_distance;
    put_camera(keyframe.camera, json);
  }
  Ordered root = {{"tureen_cameras", 1}, {"loop", path.loop_seconds > 0}};
  if (path.loop_seconds > 0) root["loop_seconds"] = path.loop_seconds;
  root["cameras"] = std::move(list);
  return text_of(root);
}

}  // namespace tureen
