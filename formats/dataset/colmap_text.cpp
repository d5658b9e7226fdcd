// COLMAP's text files: one record a line, two lines an image. Lines that begin with # are comments.
#include <algorithm>
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

/// Null if the model is unknown.
const ColmapLensModel* find_lens_model(const std::string& name) {
  for (const ColmapLensModel& model : colmap_lens_models())
    if (model.name == name) return &model;
  return nullptr;
}

/// The rest of a camera's line.
ColmapCamera read_camera(TextScanner& text) {
  ColmapCameraRecord record;
  const std::string model = text.read_word("a camera model");
  record.model = find_lens_model(model);
  if (!record.model) {
    text.read_line();
    return ColmapCamera{.defect = unsupported_model(model)};
  }
  record.width = std::uint64_t(text.read_integer("a width", 0, 1LL << 32));
  record.height = std::uint64_t(text.read_integer("a height", 0, 1LL << 32));
  while (record.parameters.size() < record.model->parameters())
    record.parameters.push_back(read_double(text, "a camera's parameter"));
  return to_camera(record);
}

bool is_number(const std::string& word) {
  double value = 0;
  const char* last = word.data() + word.size();
  const auto [end, error] = std::from_chars(word.data(), last, value);
  return end == last && error != std::errc::invalid_argument;
}

/// Number, rotation, translation, camera.
constexpr std::size_t words_before_name = 9;

/// Skips the line of features (x, y and a point's number each), which may be empty. If some program
/// has left it out, the next image is in its place: returns the words of that image.
std::vector<std::string> pass_features(TextScanner& text, const std::string& image) {
  constexpr std::size_t most = 64;  // of an image with blanks in its name
  std::vector<std::string> words;
  std::size_t count = 0;
  bool all_numbers = true;
  for (; !text.at_line_end(); ++count) {
    std::string word = text.read_word("a feature");
    all_numbers = all_numbers && is_number(word);
    if (words.size() < most) words.push_back(std::move(word));
  }
  if (all_numbers && count % 3 == 0) {
    text.next_line();
    return {};
  }
  if (count <= words_before_name || count > most ||
      !std::all_of(words.begin(), words.begin() + words_before_name, is_number))
    text.fail("the line after image " + image +
              " must hold its features, three numbers each, or be empty; it has " +
              std::to_string(count) + " words");
  return words;
}

ColmapImage image_of(TextScanner& text, const std::vector<std::string>& words) {
  const auto number = [&](std::size_t i) {
    double value = 0;
    std::from_chars(words[i].data(), words[i].data() + words[i].size(), value);
    return value;
  };
  ColmapImage image;
  ColmapPoseRecord pose;
  for (std::size_t i = 0; i < 4; ++i) pose.rotation[i] = number(1 + i);
  for (std::size_t i = 0; i < 3; ++i) pose.translation[i] = number(5 + i);
  set_pose(image, pose);
  if (!(number(8) >= 0 && number(8) <= 0xffffffff)) text.fail("a camera's number is out of range");
  image.camera = std::uint32_t(number(8));
  for (std::size_t i = words_before_name; i < words.size(); ++i)
    image.name += (image.name.empty() ? "" : " ") + words[i];
  return image;
}

}  // namespace

ColmapCameras read_colmap_cameras_text(Input& input) {
  TextScanner text(input);
  ColmapCameras cameras;
  while (next_record(text)) {
    const std::uint32_t number = read_number(text, "a camera's number");
    const ColmapCamera camera = read_camera(text);
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
    image.number = read_number(text, "an image's number");
    ColmapPoseRecord pose;
    for (double& number : pose.rotation) number = read_double(text, "a rotation");
    for (double& number : pose.translation) number = read_double(text, "a translation");
    set_pose(image, pose);
    image.camera = read_number(text, "a camera's number");
    // COLMAP does not quote names with blanks.
    image.name = text.read_line();
    if (image.name.empty()) text.fail("an image's name is missing");
    for (;;) {
      input.take_memory(1, image.name.capacity(), "the images");
      input.make_room_in(images, 1, "the images");
      images.push_back(std::move(image));
      text.next_line();
      const std::vector<std::string> next = pass_features(text, images.back().name);
      if (next.empty()) break;
      image = image_of(text, next);
    }
  }
  return images;
}

ColmapPoints read_colmap_points_text(Input& input) {
  TextScanner text(input);
  ColmapPoints read;
  while (next_record(text)) {
    input.make_room_in(read.points, 1, "the points");
    try {
      read_double(text, "a point's number");
      glm::dvec3 position;
      for (int i = 0; i < 3; ++i) position[i] = read_double(text, "a point's position");
      glm::u8vec3 color;
      for (int i = 0; i < 3; ++i) color[i] = glm::u8(text.read_integer("a colour", 0, 255));
      add_point(read, position, color);
    } catch (const InputError&) {
      ++read.skipped;  // the line is damaged; a training starts without this point
    }
    // The mean error of its projections and the images that see it.
    if (!text.next_line()) break;
  }
  return read;
}

}  // namespace tureen
