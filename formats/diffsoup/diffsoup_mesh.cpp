#include "formats/diffsoup/diffsoup_mesh.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <iterator>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>

namespace tureen {

namespace {

struct ScalarType {
  std::string_view name, other_name;
  std::size_t size;
  bool is_float, is_signed;
};

constexpr ScalarType scalar_types[] = {
    {"char", "int8", 1, false, true},    {"uchar", "uint8", 1, false, false},
    {"short", "int16", 2, false, true},  {"ushort", "uint16", 2, false, false},
    {"int", "int32", 4, false, true},    {"uint", "uint32", 4, false, false},
    {"float", "float32", 4, true, true}, {"double", "float64", 8, true, true},
};

const ScalarType* scalar_type(std::string_view name) {
  const auto* found = std::find_if(
      std::begin(scalar_types), std::end(scalar_types),
      [&](const ScalarType& type) { return type.name == name || type.other_name == name; });
  return found == std::end(scalar_types) ? nullptr : found;
}

/// A number at a fixed place of a record.
struct Field {
  const ScalarType* type = nullptr;
  std::size_t offset = 0;
};

float read_float(const std::byte* record, const Field& field) {
  if (field.type->size == 4) {
    float value;
    std::memcpy(&value, record + field.offset, sizeof value);
    return value;
  }
  double value;
  std::memcpy(&value, record + field.offset, sizeof value);
  return static_cast<float>(value);
}

std::int64_t read_integer(const std::byte* at, const ScalarType& type) {
  std::uint64_t value = 0;
  for (std::size_t i = type.size; i-- > 0;)
    value = value << 8 | std::to_integer<std::uint64_t>(at[i]);
  const bool negative = type.is_signed && (value >> (8 * type.size - 1)) != 0;
  return negative ? static_cast<std::int64_t>(value) - (std::int64_t(1) << (8 * type.size))
                  : static_cast<std::int64_t>(value);
}

/// The contents of the header. Face records are assumed to have three corners.
struct Header {
  std::uint64_t vertices = 0, faces = 0;
  std::size_t vertex_size = 0, face_size = 0;
  std::array<Field, 3> position;
  Field count;    // of a face's corners
  Field corners;  // the first of three
  std::uint64_t body = 0;
};

class HeaderReader {
 public:
  explicit HeaderReader(Input& input) : input_(input) {
    input_.seek(0);
    text_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(input_.size(), 65536)));
    input_.read(std::as_writable_bytes(std::span(text_)), "the PLY header");
  }

  Header read() {
    if (next_line() != "ply") fail("not a PLY file");
    bool format = false;
    for (;;) {
      std::istringstream words{std::string(next_line())};
      std::string word;
      words >> word;
      if (word == "end_header") break;
      if (word == "comment" || word == "obj_info" || word.empty()) continue;
      if (word == "format")
        format = read_format(words);
      else if (word == "element")
        read_element(words);
      else if (word == "property")
        read_property(words);
      else
        fail("\"" + word.substr(0, 40) + "\" is unknown in a PLY header");
    }
    if (!format) fail("the PLY header has no format");
    for (const Field& field : header_.position)
      if (!field.type) fail("vertices lack x, y or z");
    if (!header_.corners.type) fail("faces lack vertex_indices");
    header_.body = at_;
    return header_;
  }

 private:
  std::string_view next_line() {
    ++line_;
    const std::size_t end = text_.find('\n', at_);
    if (end == std::string::npos) fail("the PLY header does not end");
    std::string_view line(text_.data() + at_, end - at_);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    at_ = end + 1;
    return line;
  }

  bool read_format(std::istringstream& words) {
    std::string kind;
    words >> kind;
    if (kind != "binary_little_endian")
      fail("the PLY format is \"" + kind.substr(0, 40) + "\", expected binary_little_endian");
    return true;
  }

  void read_element(std::istringstream& words) {
    std::string name;
    std::uint64_t count = 0;
    if (!(words >> name >> count)) fail("an element without a count");
    const bool vertex = name == "vertex" && element_ == 0;
    const bool face = name == "face" && element_ == 1;
    if (!vertex && !face)
      fail("element \"" + name.substr(0, 40) + "\": expected vertex, then face, nothing else");
    ++element_;
    (vertex ? header_.vertices : header_.faces) = count;
  }

  void read_property(std::istringstream& words) {
    std::string type_name, name;
    words >> type_name;
    if (element_ == 0) fail("a property before any element");
    std::size_t& size = element_ == 1 ? header_.vertex_size : header_.face_size;
    // Far above any real record; keeps sizes within bounds.
    if (size > 65536) fail("too many properties");
    if (type_name == "list") return read_list(words);
    const ScalarType* type = scalar_type(type_name);
    if (!type || !(words >> name)) fail("a property of unknown type");
    if (element_ == 1 && (name == "x" || name == "y" || name == "z")) {
      if (!type->is_float) fail("property " + name + " is neither float nor double");
      header_.position[static_cast<std::size_t>(name[0] - 'x')] = {type, size};
    }
    size += type->size;
  }

  void read_list(std::istringstream& words) {
    std::string count_name, item_name, name;
    words >> count_name >> item_name >> name;
    const ScalarType* count = scalar_type(count_name);
    const ScalarType* item = scalar_type(item_name);
    if (!count || !item || count->is_float || item->is_float) fail("a list without integer types");
    if (element_ != 2 || header_.corners.type ||
        (name != "vertex_indices" && name != "vertex_index"))
      fail("a list that is not the one list vertex_indices of the faces");
    header_.count = {count, header_.face_size};
    header_.corners = {item, header_.face_size + count->size};
    header_.face_size += count->size + 3 * item->size;
  }

  [[noreturn]] void fail(const std::string& reason) const {
    throw InputError({input_.name(), {}, line_}, reason);
  }

  Input& input_;
  std::string text_;
  std::size_t at_ = 0;
  std::uint64_t line_ = 0;
  int element_ = 0;  // elements seen so far
  Header header_;
};

std::vector<std::byte> read_records(Input& input, std::uint64_t count, std::size_t size,
                                    const char* what) {
  // By division: a product with a false count could overflow.
  if (count > input.remaining() / size)
    input.fail(std::to_string(count) + " " + what + " of " + std::to_string(size) +
               " bytes do not fit into the " + std::to_string(input.remaining()) + " bytes left");
  if (count > 0xffffffffu) input.fail("more " + std::string(what) + " than 32 bits can count");
  return input.read_values<std::byte>(count * size, what);
}

}  // namespace

DiffSoupMesh read_diffsoup_mesh(Input& input) {
  const Header header = HeaderReader(input).read();
  DiffSoupMesh mesh;
  input.seek(header.body);
  {
    PassingMemory passing(input.budget());
    const auto bytes = read_records(input, header.vertices, header.vertex_size, "vertices");
    input.take_memory(header.vertices, sizeof mesh.positions[0], "vertices");
    passing.keep(header.vertices * sizeof mesh.positions[0]);
    mesh.positions.resize(static_cast<std::size_t>(header.vertices));
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
      for (int k = 0; k < 3; ++k)
        mesh.positions[v][k] =
            read_float(&bytes[v * header.vertex_size], header.position[std::size_t(k)]);
  }
  const std::uint64_t start = input.position();
  PassingMemory passing(input.budget());
  const auto bytes = read_records(input, header.faces, header.face_size, "faces");
  input.take_memory(header.faces, sizeof mesh.triangles[0], "faces");
  passing.keep(header.faces * sizeof mesh.triangles[0]);
  mesh.triangles.resize(static_cast<std::size_t>(header.faces));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::byte* record = &bytes[t * header.face_size];
    const auto fail = [&](const std::string& reason) {
      input.fail_at(start + t * header.face_size, "face " + std::to_string(t) + reason);
    };
    const std::int64_t corners = read_integer(record + header.count.offset, *header.count.type);
    if (corners != 3) fail(" has " + std::to_string(corners) + " corners, expected a triangle");
    for (std::size_t k = 0; k < 3; ++k) {
      const ScalarType& type = *header.corners.type;
      const std::int64_t index = read_integer(record + header.corners.offset + k * type.size, type);
      if (index < 0 || static_cast<std::uint64_t>(index) >= mesh.positions.size())
        fail(" names vertex " + std::to_string(index) + " of " +
             std::to_string(mesh.positions.size()));
      mesh.triangles[t][static_cast<int>(k)] = static_cast<std::uint32_t>(index);
    }
  }
  return mesh;
}

void write_diffsoup_mesh(Output& output, std::span<const glm::vec3> positions,
                         std::span<const glm::uvec3> triangles) {
  output.write(
      "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(positions.size()) +
      "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
      std::to_string(triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n");
  output.write(std::as_bytes(positions));
  std::array<std::byte, 13> record{std::byte(3)};
  for (const glm::uvec3& triangle : triangles) {
    std::memcpy(&record[1], &triangle, 12);
    output.write(record);
  }
}

}  // namespace tureen
