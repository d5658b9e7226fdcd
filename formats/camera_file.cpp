#include "formats/camera_file.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <nlohmann/json.hpp>
#include <optional>

#include "formats/json_file.hpp"
#include "formats/png.hpp"

namespace tureen {

namespace {

using Json = nlohmann::json;

class Reader {
 public:
  explicit Reader(std::string file) : file_(std::move(file)) {}

  CameraFile read(const Json& root) {
    if (!root.is_object()) fail("the file holds no JSON object");
    if (root.contains("frames")) {
      read_transforms(root);
    } else if (root.contains("cameras")) {
      read_ours(root);
    } else {
      fail("neither \"cameras\" nor \"frames\" is there: no camera file that we know");
    }
    return std::move(result_);
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    throw InputError({file_, {}, {}}, where_ + reason);
  }

  const Json& array(const Json& parent, const char* key) const {
    const auto found = parent.find(key);
    if (found == parent.end() || !found->is_array()) fail(std::string(key) + " is no list");
    return *found;
  }

  std::optional<double> maybe_number(const Json& parent, const char* key) const {
    const auto found = parent.find(key);
    if (found == parent.end()) return {};
    if (!found->is_number()) fail(std::string(key) + " is no number");
    return found->get<double>();
  }

  double number(const Json& parent, const char* key) const {
    const std::optional<double> value = maybe_number(parent, key);
    if (!value) fail(std::string(key) + " is missing");
    return *value;
  }

  int side(double value, const char* key) const {
    if (!(value >= 1 && value <= max_image_side) || value != std::floor(value))
      fail(std::string(key) + " is no whole number from 1 to " + std::to_string(max_image_side));
    return int(value);
  }

  void require_focal_lengths(const Camera& camera) const {
    if (!(camera.fx > 0 && camera.fy > 0)) fail("a focal length is not positive");
  }

  /// The first three rows of a matrix that is given row by row.
  glm::dmat4 matrix(const Json& parent, const char* key) const {
    const Json& rows = array(parent, key);
    if (rows.size() != 3 && rows.size() != 4) fail(std::string(key) + " has not 3 or 4 rows");
    glm::dmat4 result(1.0);
    for (int row = 0; row < 3; ++row) {
      if (!rows[row].is_array() || rows[row].size() != 4)
        fail(std::string(key) + " has a row that is not 4 numbers");
      for (int column = 0; column < 4; ++column) {
        if (!rows[row][column].is_number()) fail(std::string(key) + " holds what is no number");
        result[column][row] = rows[row][column].get<double>();
      }
    }
    require_rotation(glm::dmat3(result), key);
    return result;
  }

  void require_rotation(const glm::dmat3& m, const char* key) const {
    const glm::dmat3 error = glm::transpose(m) * m - glm::dmat3(1.0);
    // Structure from motion prints six digits or more; a scale or a shear shows far above this.
    constexpr double tolerance = 1e-3;
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r)
        if (!(std::abs(error[c][r]) < tolerance))
          fail(std::string(key) + " is no rotation: its axes are not of unit length or not square");
    if (glm::determinant(m) < 0) fail(std::string(key) + " mirrors");
  }

  void read_ours(const Json& root) {
    const auto version = root.find("tureen_cameras");
    if (version != root.end() && *version != 1) fail("tureen_cameras is not version 1");
    const Json& cameras = array(root, "cameras");
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      where_ = "camera " + std::to_string(i) + ": ";
      const Json& json = cameras[i];
      if (!json.is_object()) fail("it is no object");
      Camera camera;
      if (const auto name = json.find("name"); name != json.end() && name->is_string())
        camera.name = name->get<std::string>();
      camera.width = side(number(json, "width"), "width");
      camera.height = side(number(json, "height"), "height");
      camera.fx = number(json, "fx");
      camera.fy = number(json, "fy");
      camera.cx = number(json, "cx");
      camera.cy = number(json, "cy");
      require_focal_lengths(camera);
      camera.view_from_world = matrix(json, "view_from_world");
      result_.cameras.push_back(std::move(camera));
    }
    where_.clear();
  }

  void read_transforms(const Json& root) {
    const Json& frames = array(root, "frames");
    for (std::size_t i = 0; i < frames.size(); ++i) {
      where_ = "frame " + std::to_string(i) + ": ";
      if (!frames[i].is_object()) fail("it is no object");
      result_.cameras.push_back(frame(root, frames[i]));
    }
    where_.clear();
    if (size_assumed_)
      result_.notes.push_back("the file names no image size; 800 x 800 is assumed");
    if (distorted_)
      result_.notes.push_back(
          "the lens distortion of the file is left out: pictures are those of a pinhole");
  }

  Camera frame(const Json& root, const Json& json) {
    // A frame's own value stands above the one for all frames.
    const auto either = [&](const char* key) {
      const std::optional<double> own = maybe_number(json, key);
      return own ? own : maybe_number(root, key);
    };
    Camera camera;
    if (const auto name = json.find("file_path"); name != json.end() && name->is_string())
      camera.name = name->get<std::string>();
    const std::optional<double> width = either("w"), height = either("h");
    size_assumed_ = size_assumed_ || !width || !height;
    camera.width = side(width.value_or(800), "w");
    camera.height = side(height.value_or(800), "h");
    const auto from_angle = [&](const char* key, int size) -> std::optional<double> {
      const std::optional<double> angle = either(key);
      if (!angle) return {};
      if (!(*angle > 0 && *angle < 3.1415)) fail(std::string(key) + " is outside 0..pi");
      return 0.5 * size / std::tan(0.5 * *angle);
    };
    std::optional<double> fx = either("fl_x"), fy = either("fl_y");
    if (!fx) fx = from_angle("camera_angle_x", camera.width);
    if (!fy) fy = from_angle("camera_angle_y", camera.height);
    if (!fx && !fy) fail("neither fl_x nor camera_angle_x is there");
    camera.fx = fx ? *fx : *fy;
    camera.fy = fy ? *fy : *fx;
    require_focal_lengths(camera);
    camera.cx = either("cx").value_or(0.5 * camera.width);
    camera.cy = either("cy").value_or(0.5 * camera.height);
    for (const char* key : {"k1", "k2", "k3", "k4", "p1", "p2"})
      distorted_ = distorted_ || either(key).value_or(0) != 0;

    const glm::dmat4 world_from_view = matrix(json, "transform_matrix");
    // Six printed digits leave the axes a little off: squared up again, so that the inverse is
    // the transpose.
    const glm::dvec3 backward = glm::normalize(glm::dvec3(world_from_view[2]));
    const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3(world_from_view[1]), backward));
    const glm::dvec3 up = glm::cross(backward, right);
    const glm::dmat3 rotation = glm::transpose(glm::dmat3(right, up, backward));
    camera.view_from_world = glm::dmat4(rotation);
    camera.view_from_world[3] = glm::dvec4(-(rotation * glm::dvec3(world_from_view[3])), 1.0);
    return camera;
  }

  std::string file_;
  std::string where_;  // within the file, for messages
  CameraFile result_;
  bool size_assumed_ = false;
  bool distorted_ = false;
};

}  // namespace

CameraFile read_cameras(Input& input) { return Reader(input.name()).read(read_json(input)); }

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
