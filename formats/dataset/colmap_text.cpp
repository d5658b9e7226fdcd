// COLMAP's text files: one record a line, two lines an image. Lines that begin with # are comments.
#include <charconv>

#include "base/text_scanner.hpp"
#include "formats/dataset/colmap.hpp"
#include "formats/dataset/colmap_records.hpp"

namespace tureen {

namespace {

/// Advances to the next line that is neither blank nor a comment. Returns false at the end of the
/// file.
bool next_record(TextScanner& text) {
  while (text.next_content()) {
    if (text.peek(1) != "#") return true;
    if (!text.next_line()) return false;
  }
  return false;
}

/// The double nearest to the text.
double read_double(TextScanner& text, const char* what) {
  const std::string word = text.read_word(what);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size())
    text.fail("'" + word.substr(0, 40) + "' where " + what + " is expected: not a number");
  return value;
}

std::uint32_t read_number(TextScanner& text, const char* what) {
  return std::uint32_t(text.read_integer(what, 0, 0xffffffffLL));
}

/// Calls `convert` and adds the line of the record to its error.
template <class Convert>
auto convert_here(const TextScanner& text, Convert&& convert) {
  try {
    return convert();
  } catch (const ColmapRefusal& refusal) {
    text.fail(refusal.reason, refusal.hint);
  }
}

const ColmapLensModel& find_lens_model(const std::string& name) {
  for (const ColmapLensModel& model : colmap_lens_models())
    if (model.name == name) {
      require_undoable(model);
      return model;
    }
  throw ColmapRefusal{"the camera model '" + name.substr(0, 40) + "' is unknown"};
}

/// Skips the line of features (x, y and a point's number each), which may be empty. If it is
/// missing, the next image is in its place and must not be skipped.
void pass_features(TextScanner& text, const std::string& image) {
  std::size_t words = 0;
  for (; !text.at_line_end(); ++words) text.read_word("a feature");
  if (words % 3 != 0)
    text.fail("the line after image " + image +
              " must hold its features, three numbers each, or be empty; it has " +
              std::to_string(words) + " words");
  text.next_line();
}

}  // namespace

ColmapCameras read_colmap_cameras_text(Input& input) {
  TextScanner text(input);
  ColmapCameras cameras;
  while (next_record(text)) {
    const std::uint32_t number = read_number(text, "a camera's number");
    const ColmapCamera camera = convert_here(text, [&] {
      ColmapCameraRecord record;
      record.model = &find_lens_model(text.read_word("a camera model"));
      record.width = std::uint64_t(text.read_integer("a width", 0, 1LL << 32));
      record.height = std::uint64_t(text.read_integer("a height", 0, 1LL << 32));
      while (record.parameters.size() < record.model->parameters)
        record.parameters.push_back(read_double(text, "a camera's parameter"));
      return to_camera(record);
    });
    text.expect_line_end("the parameters of the camera model");
    input.take_memory(1, colmap_camera_bytes, "the cameras");
    if (!cameras.emplace(number, camera).second)
      text.fail("camera " + std::to_string(number) + " occurs twice");
  }
  return cameras;
}

std::vector<ColmapImage> read_colmap_images_text(Input& input) {
  TextScanner text(input);
  std::vector<ColmapImage> images;
  while (next_record(text)) {
    ColmapImage image;
    read_number(text, "an image's number");
    ColmapPoseRecord pose;
    for (double& number : pose.rotation) number = read_double(text, "a rotation");
    for (double& number : pose.translation) number = read_double(text, "a translation");
    image.view_from_world = convert_here(text, [&] { return to_view_from_world(pose); });
    image.camera = read_number(text, "a camera's number");
    image.name = text.read_word("an image's name");
    // COLMAP does not quote names with blanks. Here two blanks in a row become one.
    while (!text.at_line_end()) image.name += " " + text.read_word("an image's name");
    input.take_memory(1, image.name.capacity(), "the images");
    input.make_room_in(images, 1, "the images");
    images.push_back(std::move(image));
    text.next_line();
    pass_features(text, images.back().name);
  }
  return images;
}

std::vector<DatasetPoint> read_colmap_points_text(Input& input) {
  TextScanner text(input);
  std::vector<DatasetPoint> points;
  while (next_record(text)) {
    read_double(text, "a point's number");
    glm::dvec3 position;
    for (int i = 0; i < 3; ++i) position[i] = read_double(text, "a point's position");
    glm::u8vec3 color;
    for (int i = 0; i < 3; ++i) color[i] = glm::u8(text.read_integer("a colour", 0, 255));
    input.make_room_in(points, 1, "the points");
    points.push_back(convert_here(text, [&] { return to_point(position, color); }));
    // The mean error of its projections and the images that see it.
    if (!text.next_line()) break;
  }
  return points;
}

}  // namespace tureen
