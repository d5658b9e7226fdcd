#include "formats/camera_file.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "formats/camera_json.hpp"
#ifndef __EMSCRIPTEN__  // its sources are left out there, see CMakeLists.txt
#include "formats/colmap.hpp"
#endif
#include "formats/gaussian_cameras.hpp"
#include "formats/json_file.hpp"
#include "formats/transforms_json.hpp"

namespace tureen {

namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

const char* const distortion_note =
    "the lens distortion of the file is left out: pictures are those of a pinhole";

CameraFile from_transforms(const Json& root, const std::string& file) {
  CameraFile result;
  bool size_assumed = false, distorted = false;
  for (const TransformsFrame& frame : read_transforms(root, file)) {
    size_assumed = size_assumed || !frame.width || !frame.height;
    distorted = distorted || !frame.lens.is_pinhole() || !frame.other_lens.empty();
    result.cameras.push_back(pinhole(frame, frame.width.value_or(800), frame.height.value_or(800)));
  }
  if (size_assumed) result.notes.push_back("the file names no image size; 800 x 800 is assumed");
  if (distorted) result.notes.push_back(distortion_note);
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

CameraFile from_ours(const Json& root, const std::string& file) {
  const auto version = root.find("tureen_cameras");
  if (version != root.end() && *version != 1)
    throw InputError({file, {}, {}}, "tureen_cameras is not version 1");
  CameraFile result;
  const Json& cameras = json_list(root, "cameras", file);
  for (std::size_t i = 0; i < cameras.size(); ++i)
    result.cameras.push_back(our_camera(CameraJson(
        {.object = cameras[i], .file = file, .where = "camera " + std::to_string(i) + ": "})));
  return result;
}

#ifndef __EMSCRIPTEN__
/// The folder of COLMAP's model that `path` names in one of the ways of the header.
std::optional<fs::path> colmap_model(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored))
    return is_colmap_model(path) ? std::optional(path) : colmap_folder(path);
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
  for (const ColmapImage& image : model.images) {
    const ColmapCamera& taken_by = model.cameras.at(image.camera);
    distorted = distorted || !taken_by.lens.is_pinhole();
    Camera& camera = result.cameras.emplace_back(taken_by.pinhole);
    camera.name = image.name;
    camera.view_from_world = image.view_from_world;
  }
  if (distorted) result.notes.push_back(distortion_note);
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
  if (root.is_array()) return {read_gaussian_cameras(root, file), {}};
  if (!root.is_object()) throw InputError({file, {}, {}}, "the file holds no JSON object or list");
  if (root.contains("frames")) return from_transforms(root, file);
  if (root.contains("cameras")) return from_ours(root, file);
  throw InputError({file, {}, {}},
                   "neither \"cameras\" nor \"frames\" is there: no camera file that we know");
}

CameraFile read_cameras(const std::filesystem::path& path) {
  if (const std::optional<fs::path> folder = colmap_model(path)) return from_colmap(*folder);
  Input input = Input::open(path);
  return read_cameras(input);
}

std::string cameras_to_json(std::span<const Camera> cameras) {
  using Ordered = nlohmann::ordered_json;
  Ordered list = Ordered::array();
  for (const Camera& camera : cameras) {
    Ordered json;
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
    list.push_back(std::move(json));
  }
  const Ordered root = {{"tureen_cameras", 1}, {"cameras", std::move(list)}};
  // A name need not be UTF-8: the bytes that are not become U+FFFD instead of an exception.
  return root.dump(2, ' ', false, Ordered::error_handler_t::replace) + "\n";
}

}  // namespace tureen
