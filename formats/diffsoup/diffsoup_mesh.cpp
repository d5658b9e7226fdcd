#include "formats/diffsoup/diffsoup_mesh.hpp"

#include <array>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

#include "formats/ply/ply_header.hpp"

namespace tureen {

namespace {

/// A number at a fixed place of a record.
struct Field {
  PlyType type = PlyType::float32;
  std::size_t offset = 0;
};

float read_float(const std::byte* record, const Field& field) {
  if (field.type == PlyType::float32) {
    float value;
    std::memcpy(&value, record + field.offset, sizeof value);
    return value;
  }
  double value;
  std::memcpy(&value, record + field.offset, sizeof value);
  return static_cast<float>(value);
}

std::int64_t read_integer(const std::byte* at, PlyType type) {
  const std::size_t size = size_of(type);
  std::uint64_t value = 0;
  for (std::size_t i = size; i-- > 0;) value = value << 8 | std::to_integer<std::uint64_t>(at[i]);
  const bool is_signed = type == PlyType::int8 || type == PlyType::int16 || type == PlyType::int32;
  const bool negative = is_signed && (value >> (8 * size - 1)) != 0;
  return negative ? static_cast<std::int64_t>(value) - (std::int64_t(1) << (8 * size))
                  : static_cast<std::int64_t>(value);
}

/// The contents of the header. Face records are assumed to have three corners.
struct MeshRecords {
  std::uint64_t vertices = 0, faces = 0;
  std::size_t vertex_size = 0, face_size = 0;
  std::array<std::optional<Field>, 3> position;
  std::optional<Field> count;  // of a face's corners
  Field corners;               // the first of three
  std::uint64_t body = 0;
};

MeshRecords records_of(Input& input) {
  const PlyHeader ply = read_ply_header(input);
  const auto fail = [&](std::uint64_t line, const std::string& reason) {
    throw InputError({input.name(), {}, line}, reason);
  };
  if (ply.encoding != PlyHeader::Encoding::little_endian)
    throw InputError(
        {input.name()},
        std::string("the PLY format is ") +
            (ply.encoding == PlyHeader::Encoding::ascii ? "ascii" : "binary_big_endian") +
            ", expected binary_little_endian");
  if (ply.elements.size() != 2 || ply.elements[0].name != "vertex" ||
      ply.elements[1].name != "face")
    fail(1, "expected the elements vertex and face, in this order, and no others");
  const PlyElement &vertices = ply.elements[0], &faces = ply.elements[1];

  MeshRecords records;
  records.vertices = vertices.count;
  records.faces = faces.count;
  records.body = ply.body;
  for (const PlyProperty& property : vertices.properties) {
    if (property.count_type) fail(vertices.line, "a vertex has a list");
    const std::size_t axis = std::string_view("xyz").find(property.name);
    if (property.name.size() == 1 && axis != std::string_view::npos) {
      if (is_integer(property.type))
        fail(vertices.line, "property " + property.name + " is neither float nor double");
      records.position[axis] = {property.type, records.vertex_size};
    }
    records.vertex_size += size_of(property.type);
  }
  for (const auto& coordinate : records.position)
    if (!coordinate) fail(vertices.line, "vertices lack x, y or z");
  for (const PlyProperty& property : faces.properties) {
    if (!property.count_type) {
      records.face_size += size_of(property.type);
      continue;
    }
    if (records.count || !is_integer(property.type) ||
        (property.name != "vertex_indices" && property.name != "vertex_index"))
      fail(faces.line, "a list that is not the one list vertex_indices of integers");
    records.count = {*property.count_type, records.face_size};
    records.corners = {property.type, records.face_size + size_of(*property.count_type)};
    records.face_size += size_of(*property.count_type) + 3 * size_of(property.type);
  }
  if (!records.count) fail(faces.line, "faces lack vertex_indices");
  return records;
}

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
  const MeshRecords records = records_of(input);
  DiffSoupMesh mesh;
  input.seek(records.body);
  {
    PassingMemory passing(input.budget());
    const auto bytes = read_records(input, records.vertices, records.vertex_size, "vertices");
    input.take_memory(records.vertices, sizeof mesh.positions[0], "vertices");
    passing.keep(records.vertices * sizeof mesh.positions[0]);
    mesh.positions.resize(static_cast<std::size_t>(records.vertices));
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
      for (int k = 0; k < 3; ++k)
        mesh.positions[v][k] =
            read_float(&bytes[v * records.vertex_size], *records.position[std::size_t(k)]);
  }
  const std::uint64_t start = input.position();
  PassingMemory passing(input.budget());
  const auto bytes = read_records(input, records.faces, records.face_size, "faces");
  input.take_memory(records.faces, sizeof mesh.triangles[0], "faces");
  passing.keep(records.faces * sizeof mesh.triangles[0]);
  mesh.triangles.resize(static_cast<std::size_t>(records.faces));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::byte* record = &bytes[t * records.face_size];
    const auto fail = [&](const std::string& reason) {
      input.fail_at(start + t * records.face_size, "face " + std::to_string(t) + reason);
    };
    const std::int64_t corners = read_integer(record + records.count->offset, records.count->type);
    if (corners != 3) fail(" has " + std::to_string(corners) + " corners, expected a triangle");
    for (std::size_t k = 0; k < 3; ++k) {
      const PlyType type = records.corners.type;
      const std::int64_t index =
          read_integer(record + records.corners.offset + k * size_of(type), type);
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
