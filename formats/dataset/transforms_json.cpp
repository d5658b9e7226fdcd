#include "formats/dataset/transforms_json.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "formats/dataset/camera_json.hpp"

namespace tureen {

namespace {

using Json = nlohmann::json;

std::optional<double> positive(const CameraJson& json, const char* key) {
  const std::optional<double> value = json.maybe_number(key);
  if (value && !(*value > 0)) json.fail(std::string("the focal length is not positive: ") + key);
  return value;
}

std::optional<double> angle(const CameraJson& json, const char* key) {
  const std::optional<double> value = json.maybe_number(key);
  if (value && !(*value > 0 && *value < 3.1415)) json.fail(std::string(key) + " is outside 0..pi");
  return value;
}

/// Models that Lens describes, as nerfstudio names them.
constexpr std::array described{"",           "OPENCV",        "PINHOLE",     "SIMPLE_PINHOLE",
                               "RADIAL",     "SIMPLE_RADIAL", "PERSPECTIVE", "OPENCV_FISHEYE",
                               "FULL_OPENCV"};

bool is_fisheye(const CameraJson& json) {
  return json.truth("is_fisheye") || json.text("camera_model") == "OPENCV_FISHEYE";
}

/// instant-ngp has a key for it; nerfstudio names the model.
bool is_panorama(const CameraJson& json) {
  return json.truth("equirectangular") || json.text("camera_model") == "EQUIRECTANGULAR";
}

bool is_full(const CameraJson& json) { return json.text("camera_model") == "FULL_OPENCV"; }

std::string other_lens(const CameraJson& json) {
  for (const char* key : {"ftheta_p0", "latlong"})
    if (json.truth(key)) return key;
  if (is_panorama(json)) return {};
  std::string model = json.text("camera_model");
  if (std::find(described.begin(), described.end(), model) == described.end()) return model;
  // The fourth radial number is ambiguous: in OpenCV it belongs to a quotient of polynomials,
  // elsewhere to r^8.
  if (!is_fisheye(json) && !is_full(json) && json.maybe_number("k4").value_or(0) != 0) return "k4";
  return {};
}

/// Throws InputError.
TransformsFrame read_frame(const CameraJson& json) {
  TransformsFrame frame;
  frame.file_path = json.text("file_path");
  frame.width = json.maybe_side("w");
  frame.height = json.maybe_side("h");
  frame.mask_path = json.text("mask_path");
  frame.other_lens = other_lens(json);
  frame.view_from_world = rigid_inverse(json.rigid("transform_matrix"));
  frame.is_panorama = is_panorama(json);
  if (frame.is_panorama) return frame;
  frame.fl_x = positive(json, "fl_x");
  frame.fl_y = positive(json, "fl_y");
  if (!frame.fl_x) frame.camera_angle_x = angle(json, "camera_angle_x");
  if (!frame.fl_y) frame.camera_angle_y = angle(json, "camera_angle_y");
  if (!frame.fl_x && !frame.fl_y && !frame.camera_angle_x && !frame.camera_angle_y)
    json.fail("it has no focal length: fl_x, fl_y, camera_angle_x or camera_angle_y");
  frame.cx = json.maybe_number("cx");
  frame.cy = json.maybe_number("cy");
  const auto coefficient = [&](const char* key) { return json.maybe_number(key).value_or(0); };
  frame.is_fisheye = is_fisheye(json);
  frame.lens = {.k1 = coefficient("k1"), .k2 = coefficient("k2"), .k3 = coefficient("k3")};
  if (frame.is_fisheye || is_full(json)) frame.lens.k4 = coefficient("k4");
  if (is_full(json)) {
    frame.lens.k5 = coefficient("k5");
    frame.lens.k6 = coefficient("k6");
  }
  if (!frame.is_fisheye) {
    frame.lens.p1 = coefficient("p1");
    frame.lens.p2 = coefficient("p2");
  }
  return frame;
}

}  // namespace

std::vector<TransformsFrame> read_transforms(const Json& root, const std::string& file,
                                             const char* key) {
  const Json& frames = json_list(root, key, file);
  std::vector<TransformsFrame> result;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    try {
      result.push_back(read_frame(
          CameraJson({.object = frames[i], .common = &root, .file = file, .where = ""})));
    } catch (const InputError& error) {
      TransformsFrame& bad = result.emplace_back();
      const Json* name = frames[i].is_object() && frames[i].contains("file_path")
                             ? &frames[i]["file_path"]
                             : nullptr;
      bad.file_path =
          name && name->is_string() ? name->get<std::string>() : "frame " + std::to_string(i);
      bad.defect = error.reason();
    }
  }
  return result;
}

Camera pinhole(const TransformsFrame& frame, int width, int height) {
  const auto focal = [](std::optional<double> length, std::optional<double> full_angle,
                        int side) -> std::optional<double> {
    if (length || !full_angle) return length;
    return 0.5 * side / std::tan(0.5 * *full_angle);
  };
  const std::optional<double> fx = focal(frame.fl_x, frame.camera_angle_x, width);
  const std::optional<double> fy = focal(frame.fl_y, frame.camera_angle_y, height);
  Camera camera;
  camera.name = frame.file_path;
  camera.width = width;
  camera.height = height;
  camera.fx = fx ? *fx : *fy;  // square pixels if the file has only one of the two
  camera.fy = fy ? *fy : *fx;
  camera.cx = frame.cx.value_or(0.5 * width);
  camera.cy = frame.cy.value_or(0.5 * height);
  camera.view_from_world = frame.view_from_world;
  return camera;
}

}  // namespace tureen
