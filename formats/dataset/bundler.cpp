#include "formats/dataset/bundler.hpp"

#include <charconv>
#include <cmath>

#include "base/text_scanner.hpp"
#include "formats/dataset/camera_json.hpp"

namespace tureen {

namespace {

/// The longest line of a list of images, in bytes.
constexpr std::uint64_t max_list_line = 4096;

std::optional<double> parse_finite(const std::string& word) {
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) return {};
  return value;
}

/// The double nearest to the next word on this line.
double read_finite_here(TextScanner& text, const char* what) {
  const std::string word = text.read_word(what);
  const std::optional<double> value = parse_finite(word);
  if (!value)
    text.fail("'" + word.substr(0, 40) + "' where " + what + " is expected: not a finite number");
  return *value;
}

/// As read_finite_here, on this line or a later one.
double read_finite(TextScanner& text, const char* what) {
  text.next_content();
  return read_finite_here(text, what);
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
  LensNumbers numbers;
  numbers.k1 = read_finite(text, "a camera's k1");
  numbers.k2 = read_finite(text, "a camera's k2");
  camera.lens = brown(numbers);
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
  // The images that show it, four numbers each, all on one line.
  const std::uint64_t views = read_record_count(text, 2 * 4, "views of a point");
  for (std::uint64_t i = 0; i < 4 * views; ++i) read_finite_here(text, "a view of a point");
  text.expect_line_end("the views of a point");
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
    const std::uint64_t start = text.position();
    std::string name, last, before_last;
    // The length of the name without its last word, and without its last two.
    std::size_t without_one = 0, without_two = 0;
    while (!text.at_line_end()) {
      before_last = std::move(last);
      last = text.read_word("an image's name");
      if (text.position() - start > max_list_line)
        text.fail("the line has more than " + std::to_string(max_list_line) + " bytes");
      without_two = without_one;
      without_one = name.size();
      name += (name.empty() ? "" : " ") + last;
    }
    // "0" and an estimate of the focal length may follow the name, which is not quoted.
    if (without_two > 0 && before_last == "0" && parse_finite(last)) name.resize(without_two);
    name.shrink_to_fit();
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
