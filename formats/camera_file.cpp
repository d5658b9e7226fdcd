#include "formats/camera_file.hpp"

#include <nlohmann/json.hpp>

#include "formats/camera_json.hpp"
#include "formats/json_file.hpp"
#include "formats/transforms_json.hpp"

namespace tureen {

namespace {

using Json = nlohmann::json;

CameraFile from_transforms(const Json& root, const std::string& file) {
  CameraFile result;
  bool size_assumed = false, distorted = false;
  for (const TransformsFrame& frame : read_transforms(root, file)) {
    size_assumed = size_assumed || !frame.width || !frame.height;
    distorted = distorted || !frame.lens.is_pinhole() || !frame.other_lens.empty();
    result.cameras.push_back(pinhole(frame, frame.width.value_or(800), frame.height.value_or(800)));
  }
  if (size_assumed) result.notes.push_back("the file names no image size; 800 x 800 is assumed");
  if (distorted)
    result.notes.push_back(
        "the lens distortion of the file is left out: pictures are those of a pinhole");
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

}  // namespace

CameraFile read_cameras(Input& input) {
  const Json root = read_json(input);
  const std::string& file = input.name();
  if (!root.is_object()) throw InputError({file, {}, {}}, "the file holds no JSON object");
  if (root.contains("frames")) return from_transforms(root, file);
  if (root.contains("cameras")) return from_ours(root, file);
  throw InputError({file, {}, {}},
                   "neither \"cameras\" nor \"frames\" is there: no camera file that we know");
}

CameraFile read_cameras(const std::filesystem::path& path) {
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
