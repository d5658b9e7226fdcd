#include "formats/dataset/bundler.hpp"

#include <charconv>
#include <cmath>

#include "base/text_scanner.hpp"
#include "formats/dataset/camera_json.hpp"

namespace tureen {

namespace {

/// The double nearest to the next word, on this line or a later one.
double read_finite(TextScanner& text, const char* what) {
  text.next_content();
  const std::string word = text.read_word(what);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
    text.fail("'" + word.substr(0, 40) + "' where " + what + " is expected: not a finite number");
  return value;
}

/// A number of records of at least `bytes` bytes each.
std::uint64_t read_record_count(TextScanner& text, std::uint64_t bytes, const char* what) {
  text.next_content();
  const auto count = std::uint64_t(text.read_integer(what, 0, 1LL << 40));
  if (count > text.remaining() / bytes)
    text.fail(std::to_string(count) + " " + what + " do not fit in the " +
              std::to_string(text.remaining()) + " bytes left");
  return count;
}

BundlerCamera read_bundler_camera(TextScanner& text) {
  BundlerCamera camera;
  camera.focal = read_finite(text, "a focal length");
  if (camera.focal < 0) text.fail("a focal length is negative");
  camera.lens.k1 = read_finite(text, "a camera's k1");
  camera.lens.k2 = read_finite(text, "a camera's k2");
  glm::dmat4 view(1.0);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) view[column][row] = read_finite(text, "a rotation");
  for (int row = 0; row < 3; ++row) view[3][row] = read_finite(text, "a translation");
  // Images without a pose have zeros.
  if (camera.focal == 0) return camera;
  if (const char* defect = rotation_defect(glm::dmat3(view)))
    text.fail("the rotation of the camera before this line " + std::string(defect));
  camera.view_from_world = rigid_inverse(rigid_inverse(view));
  return camera;
}

DatasetPoint read_bundler_point(TextScanner& text) {
  DatasetPoint point{};
  for (int i = 0; i < 3; ++i) point.position[i] = read_finite(text, "a point's position");
  text.next_content();
  for (int i = 0; i < 3; ++i) point.color[i] = glm::u8(text.read_integer("a colour", 0, 255));
  // The images that show it, four numbers each.
  text.next_line();
  text.next_content();
  text.next_line();
  return point;
}

}  // namespace

BundlerModel read_bundler(Input& input) {
  TextScanner text(input);
  for (const char* word : {"#", "Bundle", "file", "v0.3"})
    if (text.at_line_end() || text.read_word("the version") != word)
      text.fail("the first line is not \"# Bundle file v0.3\"");
  BundlerModel model;
  // Numbers and blanks: 15 of a camera, 7 of a point.
  const std::uint64_t cameras = read_record_count(text, 2 * 15 - 1, "cameras");
  const std::uint64_t points = read_record_count(text, 2 * 7 - 1, "points");
  input.make_room_in(model.cameras, cameras, "the cameras");
  for (std::uint64_t i = 0; i < cameras; ++i) model.cameras.push_back(read_bundler_camera(text));
  input.make_room_in(model.points, points, "the points");
  for (std::uint64_t i = 0; i < points; ++i) model.points.push_back(read_bundler_point(text));
  return model;
}

std::vector<std::string> read_bundler_list(Input& input) {
  TextScanner text(input);
  std::vector<std::string> names;
  while (text.next_content()) {
    std::vector<std::string> words;
    while (!text.at_line_end()) words.push_back(text.read_word("an image's name"));
    // "0" and an estimate of the focal length may follow the name, which is not quoted.
    if (words.size() >= 3 && words[words.size() - 2] == "0") words.resize(words.size() - 2);
    std::string name = words[0];
    for (std::size_t i = 1; i < words.size(); ++i) name += " " + words[i];
    input.take_memory(1, name.capacity(), "the names of images");
    input.make_room_in(names, 1, "the names of images");
    names.push_back(std::move(name));
    if (!text.next_line()) break;
  }
  return names;
}

std::optional<BundlerFiles> bundler_files(const std::filesystem::path& dataset) {
  const auto first = [&](std::initializer_list<const char*> names) -> std::filesystem::path {
    std::error_code ignored;
    for (const char* name : names)
      if (std::filesystem::is_regular_file(dataset / name, ignored)) return dataset / name;
    return {};
  };
  const std::filesystem::path model = first({"bundle.out", "bundle/bundle.out"});
  if (model.empty()) return {};
  return BundlerFiles{model, first({"list.txt", "bundle.out.list.txt", "bundle/list.txt",
                                    "bundle/bundle.out.list.txt"})};
}

}  // namespace tureen
