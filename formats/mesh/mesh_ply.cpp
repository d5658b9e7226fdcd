#include "formats/mesh/mesh_ply.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>

#include "base/output.hpp"
#include "formats/common/format_remarks.hpp"
#include "formats/mesh/plain_mesh.hpp"
#include "formats/ply/ply_bytes.hpp"
#include "formats/ply/ply_values.hpp"
#include "image/quantise.hpp"
#include "scene/edit/moved_normals.hpp"

namespace tureen {

namespace {

/// Slots of scalar properties: 0..2 x y z, 3..6 red green blue alpha, 7..9 nx ny nz.
constexpr int slots = 10;
constexpr int first_color = 3;
constexpr int first_normal = 7;
constexpr int none = -1;

/// The layout of an element, computed once from its properties.
struct Layout {
  std::vector<int> slot;               // one a property; none: skipped
  std::array<double, slots> unit{};    // divisor of each slot
  std::optional<std::size_t> indices;  // the list of vertex indices
  bool has_color = false, has_normal = false;
};

class PlyReader {
 public:
  PlyReader(Input& input, const PlyHeader& header, const ReadOptions& options)
      : input_(input), header_(header), values_(input, header, options) {}

  Scene read() {
    check_kind();
    for (const PlyElement& element : header_.elements) {
      if (element.name == "vertex")
        read_vertices(element);
      else if (element.name == "face")
        read_faces(element);
      else if (element.name == "tristrips")
        read_strips(element);
      else
        values_.skip_rows(element);
    }
    std::optional<Remark> trailing;
    if (values_.anything_left())
      trailing = Remark{&remarks::bytes_ignored, {{"bytes", values_.remaining()}}};
    Scene scene = mesh_.finish(std::filesystem::path(input_.name()).stem().string(), "PLY");
    if (trailing) scene.info.remarks.push_back(*trailing);
    if (rounded_) scene.info.remarks.push_back({&remarks::coordinates_rounded});
    return scene;
  }

 private:
  /// Rejects files without triangles; the error describes their contents.
  void check_kind() {
    const PlyElement* vertex = header_.find("vertex");
    if (!vertex)
      throw InputError({input_.name(), {}, header_.body_line - 1}, "has no element 'vertex'");
    vertices_ = vertex->count;
    for (const char* name : {"face", "tristrips"})
      if (const PlyElement* faces = header_.find(name); faces && faces->count > 0) return;
    if (vertices_ > 0)
      fail_element(input_, *vertex,
                   "is a point cloud: " + std::to_string(vertices_) + " vertices and no faces");
  }

  Layout layout_of(const PlyElement& element) {
    static constexpr std::array<const char*, slots> names{"x",    "y",     "z",  "red", "green",
                                                          "blue", "alpha", "nx", "ny",  "nz"};
    Layout layout;
    layout.slot.assign(element.properties.size(), none);
    std::array<bool, slots> found{};
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      std::string_view name = property.name;
      if (name.substr(0, 8) == "diffuse_") name.remove_prefix(8);
      const auto slot = std::size_t(std::find(names.begin(), names.end(), name) - names.begin());
      if (slot == names.size()) continue;
      if (slot >= first_normal && element.name != "vertex") continue;
      if (found[slot])
        fail_element(input_, element, "has a second property '" + property.name + "'");
      if (property.count_type) fail_element(input_, element, "has a list '" + property.name + "'");
      found[slot] = true;
      layout.slot[i] = int(slot);
      const bool is_color = slot >= first_color && slot < first_normal;
      layout.unit[slot] = is_color ? unit_of(element, property) : 1.0;
    }
    layout.has_normal = found[first_normal] && found[first_normal + 1] && found[first_normal + 2];
    layout.has_color = found[3] || found[4] || found[5];
    for (std::size_t slot = 3; slot < 6; ++slot)
      if (layout.has_color && !found[slot])
        fail_element(input_, element, std::string("has colours that lack '") + names[slot] + "'");
    if (element.name == "vertex")
      for (std::size_t slot = 0; slot < 3; ++slot)
        if (!found[slot]) fail_element(input_, element, std::string("lacks '") + names[slot] + "'");
    return layout;
  }

  double unit_of(const PlyElement& element, const PlyProperty& property) {
    switch (property.type) {
      case PlyType::uint8:
        return 255.0;
      case PlyType::uint16:
        return 65535.0;
      case PlyType::float32:
      case PlyType::float64:
        return 1.0;
      default:
        fail_element(input_, element,
                     "has a colour '" + property.name +
                         "' of a type without a defined scale; supported: uchar, ushort, "
                         "float and double");
    }
  }

  void find_indices(const PlyElement& element, Layout& layout) {
    for (const char* name : {"vertex_indices", "vertex_index"})
      if (!layout.indices) layout.indices = element.find(name);
    if (!layout.indices) fail_element(input_, element, "lacks 'vertex_indices'");
    const PlyProperty& list = element.properties[*layout.indices];
    if (!list.count_type || !is_integer(list.type))
      fail_element(input_, element, "has '" + list.name + "' that are not a list of integers");
  }

  /// The value of a slot; colours are divided as floats, so that a byte k is float(k) / 255.
  static float scaled(double value, double unit) {
    return unit == 1.0 ? static_cast<float>(value) : static_cast<float>(value) / float(unit);
  }

  void read_vertices(const PlyElement& element) {
    const Layout layout = layout_of(element);
    for (std::size_t i = 0; i < element.properties.size(); ++i)
      if (layout.slot[i] != none && layout.slot[i] < first_color &&
          element.properties[i].type == PlyType::float64 && !ascii())
        rounded_ = true;
    // The header check guarantees that the rows fit in the file.
    mesh_.reserve_vertices(element.count);
    if (layout.has_color) mesh_.reserve_colors_of_vertices(element.count);
    if (layout.has_normal) mesh_.reserve_normals(element.count);
    for (std::uint64_t v = 0; v < element.count; ++v) {
      std::array<float, slots> row{0, 0, 0, 0, 0, 0, 1, 0, 0, 0};
      values_.read_row(element, layout.slot, [&](std::size_t slot, double value) {
        row[slot] = scaled(value, layout.unit[slot]);
      });
      mesh_.positions.emplace_back(row[0], row[1], row[2]);
      if (layout.has_color) mesh_.vertex_rgba.emplace_back(row[3], row[4], row[5], row[6]);
      if (layout.has_normal) mesh_.normals.push_back(unit_or_zero({row[7], row[8], row[9]}));
    }
  }

  void read_faces(const PlyElement& element) {
    if (element.count == 0) return;
    Layout layout = layout_of(element);
    find_indices(element, layout);
    const PlyProperty& list = element.properties[*layout.indices];
    // A triangle takes a count and three indices.
    const std::uint64_t least = ascii() ? 8 : size_of(*list.count_type) + 3 * size_of(list.type);
    mesh_.reserve_faces(std::min(element.count, values_.remaining() / least + 1));
    for (std::uint64_t f = 0; f < element.count; ++f) {
      values_.begin_row(element);
      mesh_.begin_face();
      glm::vec4 rgba(0.0f, 0.0f, 0.0f, 1.0f);
      for (std::size_t i = 0; i < element.properties.size(); ++i) {
        const PlyProperty& property = element.properties[i];
        const int slot = layout.slot[i];
        if (i == *layout.indices) {
          const std::uint64_t corners = values_.read_count(property);
          for (std::uint64_t k = 0; k < corners; ++k)
            mesh_.add_corner(vertex_index(values_.read(property.type), element, f));
        } else if (slot >= first_color) {
          rgba[slot - first_color] =
              scaled(values_.read(property.type), layout.unit[std::size_t(slot)]);
        } else {
          values_.skip(property);
        }
      }
      values_.end_row();
      if (layout.has_color)
        mesh_.end_face(rgba);
      else
        mesh_.end_face();
    }
  }

  void read_strips(const PlyElement& element) {
    Layout layout = layout_of(element);
    find_indices(element, layout);
    for (std::uint64_t s = 0; s < element.count; ++s) {
      values_.begin_row(element);
      for (std::size_t i = 0; i < element.properties.size(); ++i) {
        if (i == *layout.indices)
          read_strip(element, s, element.properties[i]);
        else
          values_.skip(element.properties[i]);
      }
      values_.end_row();
    }
  }

  void read_strip(const PlyElement& element, std::uint64_t strip, const PlyProperty& list) {
    const std::uint64_t count = values_.read_count(list);
    std::uint64_t length = 0;  // of the strip since its last beginning
    glm::uvec3 last(0);
    for (std::uint64_t k = 0; k < count; ++k) {
      const double value = values_.read(list.type);
      if (value == -1.0) {
        length = 0;
        continue;
      }
      last = {last.y, last.z, vertex_index(value, element, strip)};
      if (++length < 3) continue;
      // Every other triangle of a strip has the opposite orientation.
      mesh_.add_triangle(length % 2 ? last : glm::uvec3(last.y, last.x, last.z));
    }
  }

  std::uint32_t vertex_index(double value, const PlyElement& element, std::uint64_t row) {
    if (!(value >= 0.0 && value < double(vertices_)))
      values_.fail("'" + element.name + "' " + std::to_string(row) + " names vertex " +
                   std::to_string(std::int64_t(value)) + " of " + std::to_string(vertices_));
    return static_cast<std::uint32_t>(value);
  }

  bool ascii() const { return header_.encoding == PlyHeader::Encoding::ascii; }

  Input& input_;
  const PlyHeader& header_;
  PlyValues values_;
  MeshBuilder mesh_{input_};
  std::uint64_t vertices_ = 0;
  bool rounded_ = false;
};

void write_color(PlyBytes& bytes, const glm::vec4& rgba, bool as_bytes) {
  for (int c = 0; c < 4; ++c)
    if (as_bytes)
      bytes.byte(quantised_unit(rgba[c]));
    else
      bytes.real(rgba[c]);
}

std::string color_properties(bool as_bytes) {
  std::string text;
  for (const char* name : {"red", "green", "blue", "alpha"})
    text += std::string("property ") + (as_bytes ? "uchar " : "float ") + name + "\n";
  return text;
}

}  // namespace

Scene read_mesh_ply(Input& input, const PlyHeader& header, const ReadOptions& options) {
  return PlyReader(input, header, options).read();
}

std::vector<std::string> write_mesh_ply(const Scene& scene, const std::filesystem::path& path) {
  PlainMesh mesh(scene, "PLY");
  const TriangleSoup& soup = mesh.soup();
  const auto* face_rgba = mesh.face_rgba();
  const auto* vertex_rgba = mesh.vertex_rgba();
  // Indices are written as int, which every reader supports.
  if (soup.positions.size() > std::size_t(std::numeric_limits<std::int32_t>::max()))
    throw UsageError("PLY cannot hold more than 2147483647 vertices");
  const bool as_bytes = are_bytes(face_rgba ? *face_rgba : *vertex_rgba);

  Output output(path);
  std::string header = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                       std::to_string(soup.positions.size()) +
                       "\nproperty float x\nproperty float y\nproperty float z\n";
  if (!soup.normals.empty()) header += "property float nx\nproperty float ny\nproperty float nz\n";
  if (vertex_rgba) header += color_properties(as_bytes);
  header += "element face " + std::to_string(soup.triangles.size()) +
            "\nproperty list uchar int vertex_indices\n";
  if (face_rgba) header += color_properties(as_bytes);
  output.write(std::string_view(header + "end_header\n"));

  PlyBytes writer(output);
  for (std::size_t i = 0; i < soup.positions.size(); ++i) {
    for (int k = 0; k < 3; ++k) writer.real(soup.positions[i][k]);
    for (int k = 0; k < 3 && !soup.normals.empty(); ++k) writer.real(soup.normals[i][k]);
    if (vertex_rgba) write_color(writer, (*vertex_rgba)[i], as_bytes);
  }
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    writer.byte(3);
    for (int k = 0; k < 3; ++k) writer.word(soup.triangles[t][k]);
    if (face_rgba) write_color(writer, (*face_rgba)[t], as_bytes);
  }
  writer.flush();
  output.commit();
  return std::move(mesh.lost);
}

}  // namespace tureen
