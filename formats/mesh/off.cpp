#include "formats/mesh/off.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <optional>
#include <string_view>

#include "base/decimal.hpp"
#include "base/output.hpp"
#include "base/text_scanner.hpp"
#include "formats/common/progress_meter.hpp"
#include "formats/mesh/mesh_remarks.hpp"
#include "formats/mesh/plain_mesh.hpp"
#include "image/quantise.hpp"

namespace tureen {

namespace {

/// The header word up to and including "OFF" at the start of `text`: "OFF", "STCNOFF", .. Empty if
/// there is none.
std::string_view header_word(std::string_view text) {
  const std::size_t prefix = std::min(text.find_first_not_of("STCN4n"), text.size());
  return text.substr(prefix, 3) == "OFF" ? text.substr(0, prefix + 3) : std::string_view();
}

/// The remaining numbers of a line, and whether all are integers.
struct Numbers {
  static constexpr int most = 5;  // one more than any colour has
  std::array<float, most> values{};
  int count = 0;
  bool whole = true;

  /// The count for a message, including `others` preceding numbers.
  std::string described(int others) const {
    return std::to_string(others + count) + (count == most ? " or more" : "");
  }
};

Numbers read_numbers(TextScanner& scanner, const char* what) {
  Numbers numbers;
  while (numbers.count < Numbers::most && !scanner.at_line_end()) {
    const Decimal number = scanner.read_decimal(what);
    numbers.values[std::size_t(numbers.count++)] = number.value;
    numbers.whole &= number.is_integer;
  }
  return numbers;
}

/// Distinguishes byte colours from float colours over a whole file. A float writer may print (1, 0,
/// 0) as "1 0 0", a byte writer's near-black; only the file's other colours resolve this.
class ColorScale {
 public:
  explicit ColorScale(Input& input) : input_(input) {}

  /// The colour in `numbers` (three or four), for the elements [first, end) of a list.
  glm::vec4 read(const TextScanner& scanner, const Numbers& numbers, std::size_t first,
                 std::size_t end) {
    glm::vec4 color(0.0f, 0.0f, 0.0f, 1.0f);
    float largest = 0.0f;
    for (int c = 0; c < numbers.count; ++c) {
      const float value = numbers.values[std::size_t(c)];
      if (numbers.whole && !(value >= 0.0f && value <= 255.0f))
        scanner.fail("a colour component of " + float_text(value) + " is outside 0..255");
      largest = std::max(largest, value);
      color[c] = numbers.whole ? value / 255.0f : value;
    }
    if (!numbers.whole)
      floats_ = true;
    else if (largest > 1.0f)
      bytes_ = true;
    else if (largest == 1.0f)
      remember({first, end, numbers.count});
    return color;
  }

  /// Corrects the doubtful colours once all have been read.
  void settle(std::vector<glm::vec4>& rgba) const {
    if (bytes_ && !floats_) return;
    for (const Doubtful& doubtful : doubtful_)
      for (std::size_t i = doubtful.first; i < doubtful.end; ++i)
        for (int c = 0; c < doubtful.components; ++c) rgba[i][c] = rgba[i][c] > 0.0f ? 1.0f : 0.0f;
  }

 private:
  struct Doubtful {
    std::size_t first, end;
    int components;
  };
  void remember(const Doubtful& doubtful) {
    if (doubtful_.size() == doubtful_.capacity())
      input_.make_room_in(doubtful_, 1, "the colours of the faces");
    doubtful_.push_back(doubtful);
  }

  Input& input_;
  bool bytes_ = false, floats_ = false;
  std::vector<Doubtful> doubtful_;  // only 0s and 1s, at least one 1
};

class OffReader {
 public:
  OffReader(Input& input, const ReadOptions& options)
      : input_(input), scanner_(input, {.comment = '#'}), meter_(options) {}

  Scene read() {
    read_header();
    read_vertices();
    read_faces();
    std::optional<Remark> trailing;
    if (scanner_.next_content())
      trailing = Remark{&remarks::text_ignored, {{"line", scanner_.line()}}};
    vertex_scale_.settle(mesh_.vertex_rgba);
    face_scale_.settle(mesh_.face_rgba());
    Scene scene = mesh_.finish(std::filesystem::path(input_.name()).stem().string(), "OFF");
    if (indexed_colors_ > 0)
      scene.info.remarks.push_back({&remarks::face_colors_mapped, {{"faces", indexed_colors_}}});
    if (trailing) scene.info.remarks.push_back(*trailing);
    return scene;
  }

 private:
  void read_header() {
    if (!scanner_.next_content()) scanner_.fail("the file is empty, OFF or COFF is expected");
    const std::string word(header_word(scanner_.peek(9)));
    if (word.empty()) scanner_.fail("does not begin with OFF or COFF");
    if (word != "OFF" && word != "COFF")
      scanner_.fail(word + " is an unsupported variant of OFF: " + kind(word),
                    "write it as OFF or COFF");
    scanner_.skip(word.size());
    if (!scanner_.next_content()) scanner_.fail("the file ends after its first word");
    if (scanner_.peek(7) == "BINARY")
      scanner_.fail("binary OFF is not supported", "write it as text");

    constexpr std::int64_t most = std::numeric_limits<std::uint32_t>::max();
    vertices_ = std::uint64_t(scanner_.read_integer("the number of vertices", 0, most));
    if (!scanner_.next_content()) scanner_.fail("the number of faces is missing");
    faces_ = std::uint64_t(scanner_.read_integer("the number of faces", 0, most));
    if (!scanner_.at_line_end()) scanner_.read_integer("the number of edges");
    scanner_.expect_line_end("the numbers of vertices, faces and edges");

    // "0 0 0" and a line end for a vertex, "0" and a line end for a face; the last may be missing.
    const std::uint64_t least = 6 * vertices_ + 2 * faces_;
    if (least > scanner_.remaining() + 1)
      scanner_.fail(std::to_string(vertices_) + " vertices and " + std::to_string(faces_) +
                    " faces do not fit into the " + std::to_string(scanner_.remaining()) +
                    " bytes that follow");
  }

  static const char* kind(const std::string& word) {
    if (word.find('4') != std::string::npos) return "with points of four dimensions";
    if (word.find('n') != std::string::npos) return "with points of any dimension";
    if (word.find('S') != std::string::npos) return "with texture coordinates";
    return "with normals";
  }

  void read_vertices() {
    mesh_.reserve_vertices(vertices_);
    int components = 0;
    for (std::uint64_t i = 0; i < vertices_; ++i) {
      next("vertex", i, vertices_);
      glm::vec3 position;
      for (int k = 0; k < 3; ++k) position[k] = scanner_.read_float("a vertex coordinate");
      mesh_.positions.push_back(position);
      const Numbers color = read_numbers(scanner_, "a colour component");
      if (i == 0) {
        // All lines must have the columns of the first.
        components = color.count;
        if (components != 0 && components != 3 && components != 4)
          scanner_.fail("a vertex of " + color.described(3) +
                        " numbers, expected x y z and, for a colour, r g b or r g b a");
        if (components > 0) mesh_.reserve_colors_of_vertices(vertices_);
      } else if (color.count != components) {
        scanner_.fail("a vertex of " + color.described(3) + " numbers, but the first one has " +
                      std::to_string(3 + components));
      }
      if (components > 0)
        mesh_.vertex_rgba.push_back(vertex_scale_.read(scanner_, color, i, i + 1));
    }
  }

  void read_faces() {
    // A triangle takes at least eight characters: "3 0 0 0" and a line end.
    mesh_.reserve_faces(std::min(faces_, scanner_.remaining() / 8 + 1));
    for (std::uint64_t i = 0; i < faces_; ++i) {
      next("face", i, faces_);
      mesh_.begin_face();
      const std::size_t first = mesh_.triangle_count();
      const std::int64_t corners = scanner_.read_integer("a face's number of corners", 0,
                                                         std::numeric_limits<std::uint32_t>::max());
      for (std::int64_t k = 0; k < corners; ++k) {
        const std::int64_t vertex = scanner_.read_integer("a vertex index");
        if (vertex < 0 || std::uint64_t(vertex) >= vertices_)
          scanner_.fail("face " + std::to_string(i) + " names vertex " + std::to_string(vertex) +
                        " of " + std::to_string(vertices_));
        mesh_.add_corner(static_cast<std::uint32_t>(vertex));
      }
      end_face(read_numbers(scanner_, "a colour component"), first);
    }
  }

  void end_face(const Numbers& color, std::size_t first_triangle) {
    if (color.count == 3 || color.count == 4) {
      mesh_.end_face(face_scale_.read(scanner_, color, first_triangle, mesh_.triangle_count()));
    } else if (color.count <= 1) {
      indexed_colors_ += std::uint64_t(color.count);
      mesh_.end_face();
    } else {
      scanner_.fail("a face colour of " + color.described(0) +
                    " numbers, expected r g b or r g b a");
    }
  }

  void next(const char* what, std::uint64_t index, std::uint64_t count) {
    meter_.step([&] { return double(scanner_.position()) / double(input_.size()); });
    if (!scanner_.next_content())
      scanner_.fail("the file ends before " + std::string(what) + " " + std::to_string(index) +
                    " of " + std::to_string(count));
  }

  Input& input_;
  TextScanner scanner_;
  ProgressMeter meter_;
  MeshBuilder mesh_{input_};
  ColorScale vertex_scale_{input_}, face_scale_{input_};
  std::uint64_t vertices_ = 0, faces_ = 0;
  std::uint64_t indexed_colors_ = 0;
};

/// Writes lines of text to the file in blocks.
class LineWriter {
 public:
  explicit LineWriter(Output& output) : output_(output) { text_.reserve(block + 256); }
  void number(float value) {
    char buffer[max_float_text];
    text_.append(buffer, format_float(buffer, value));
  }
  void number(std::uint64_t value) {
    char buffer[20];
    text_.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
  }
  void space() { text_ += ' '; }
  enum class Alpha { always, where_not_opaque };
  /// As bytes; alpha stays on its side of the threshold.
  void color(const glm::vec4& rgba, Alpha write_alpha) {
    for (int c = 0; c < 3; ++c) {
      space();
      number(std::uint64_t(quantised_unit(rgba[c])));
    }
    const std::uint64_t alpha = quantised_alpha(rgba.a);
    if (write_alpha == Alpha::where_not_opaque && alpha == 255) return;
    space();
    number(alpha);
  }
  void text(std::string_view text) { text_ += text; }
  void end_line() {
    text_ += '\n';
    if (text_.size() >= block) flush();
  }
  void flush() {
    output_.write(std::string_view(text_));
    text_.clear();
  }

 private:
  static constexpr std::size_t block = 64 * 1024;
  Output& output_;
  std::string text_;
};

}  // namespace

bool is_off(std::span<const std::byte> head) {
  Input input = Input::memory("", head);
  TextScanner scanner(input, {.comment = '#'});
  return scanner.next_content() && !header_word(scanner.peek(9)).empty();
}

Scene read_off(Input& input, const ReadOptions& options) {
  return OffReader(input, options).read();
}

Scene read_off(const std::filesystem::path& path, const ReadOptions& options) {
  Input input = Input::open(path);
  return read_off(input, options);
}

std::vector<std::string> write_off(const Scene& scene, const std::filesystem::path& path) {
  PlainMesh mesh(scene, "OFF");
  const TriangleSoup& soup = mesh.soup();
  const auto* face_rgba = mesh.face_rgba();
  const auto* vertex_rgba = mesh.vertex_rgba();
  if (!are_bytes(face_rgba ? *face_rgba : *vertex_rgba))
    mesh.lost.push_back("OFF holds colours in 8 bits: they are rounded.");
  if (!soup.normals.empty()) mesh.lost.push_back("OFF holds no normals.");

  Output output(path);
  LineWriter writer(output);
  writer.text(vertex_rgba ? "COFF\n" : "OFF\n");
  writer.number(std::uint64_t(soup.positions.size()));
  writer.space();
  writer.number(std::uint64_t(soup.triangles.size()));
  writer.text(" 0\n");
  for (std::size_t i = 0; i < soup.positions.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      if (k > 0) writer.space();
      writer.number(soup.positions[i][k]);
    }
    // All vertices must have as many numbers as the first, so alpha is always written.
    if (vertex_rgba) writer.color((*vertex_rgba)[i], LineWriter::Alpha::always);
    writer.end_line();
  }
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    writer.text("3");
    for (int k = 0; k < 3; ++k) {
      writer.space();
      writer.number(std::uint64_t(soup.triangles[t][k]));
    }
    if (face_rgba) writer.color((*face_rgba)[t], LineWriter::Alpha::where_not_opaque);
    writer.end_line();
  }
  writer.flush();
  output.commit();
  return std::move(mesh.lost);
}

}  // namespace tureen
