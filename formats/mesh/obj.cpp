#include "formats/mesh/obj.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "base/decimal.hpp"
#include "base/text_scanner.hpp"

namespace tureen {

namespace {

constexpr std::uint32_t no_uv = std::numeric_limits<std::uint32_t>::max();
/// A hostile file could name millions.
constexpr std::size_t max_libraries = 64;

class ObjReader {
 public:
  ObjReader(Input& input, const ObjRules& rules)
      : input_(input), rules_(rules), text_(input, {.comment = '#'}) {}

  ObjMesh read() {
    while (text_.next_content()) {
      read_line(text_.peek(8));
      if (!text_.next_line()) break;
    }
    if (!mesh_.rgb.empty()) fill_colors(positions_.size());
    if (uv_.empty() && !rules_.only_uv) {
      mesh_.positions = std::move(positions_);
    } else {
      unify_vertices();
    }
    return std::move(mesh_);
  }

 private:
  template <class T>
  void append(std::vector<T>& values, const T& value) {
    if (values.size() == values.capacity()) input_.make_room_in(values, 1, "the mesh");
    values.push_back(value);
  }

  void read_line(std::string_view keyword) {
    if (keyword == "v") {
      text_.skip(1);
      const float x = text_.read_float("x"), y = text_.read_float("y");
      append(positions_, {x, y, text_.read_float("z")});
      if (!rules_.only_uv) read_color();
    } else if (keyword == "vt") {
      text_.skip(2);
      const float u = text_.read_float("u");
      const bool has_v = rules_.only_uv || !text_.at_line_end();
      append(uv_, {u, has_v ? text_.read_float("v") : 0.0f});
    } else if (keyword == "f") {
      text_.skip(1);
      read_face();
    } else if (rules_.only_uv) {
      return;
    } else if (keyword == "usemtl") {
      text_.skip(6);
      use_material(text_.read_line());
    } else if (keyword == "mtllib") {
      text_.skip(6);
      std::vector<std::string>& all = mesh_.libraries;
      std::string name = text_.read_line();
      if (all.size() < max_libraries && std::find(all.begin(), all.end(), name) == all.end())
        all.push_back(std::move(name));
    } else if (keyword == "p" || keyword == "l") {
      ++mesh_.points_and_lines;
    }
  }

  /// Three numbers after the position; a single one is its weight.
  void read_color() {
    std::array<float, 4> values{};
    std::size_t count = 0;
    while (count < values.size() && !text_.at_line_end())
      values[count++] = text_.read_float("a colour");
    if (count < 3) return;
    fill_colors(positions_.size() - 1);
    append(mesh_.rgb, {values[0], values[1], values[2]});
  }

  void fill_colors(std::size_t count) {
    while (mesh_.rgb.size() < count) append(mesh_.rgb, glm::vec3(0.8f));
  }

  void use_material(std::string name) {
    const auto [found, is_new] =
        material_by_name_.try_emplace(std::move(name), std::uint32_t(mesh_.materials.size()));
    material_ = found->second;
    if (!is_new) return;
    input_.take_memory(bytes_a_vertex + 2 * (sizeof(std::string) + found->first.size()), 1,
                       "the materials");
    mesh_.materials.push_back(found->first);
  }

  struct Corner {
    std::uint32_t position, uv;
  };

  void read_face() {
    Corner first{}, previous{};
    int corners = 0;
    while (!text_.at_line_end()) {
      if (text_.peek(2) == "\\") {
        if (!text_.next_line()) break;
        continue;
      }
      const Corner corner = read_corner();
      if (corners >= 2) add({first, previous, corner});
      if (corners == 0) first = corner;
      previous = corner;
      ++corners;
    }
    if (corners < 3 && rules_.only_uv)
      text_.fail("a face of " + std::to_string(corners) + " corners");
    mesh_.polygons += corners > 3 ? 1 : 0;
    mesh_.small_faces += corners < 3 ? 1 : 0;
  }

  void add(const std::array<Corner, 3>& corners) {
    append(mesh_.triangles, {corners[0].position, corners[1].position, corners[2].position});
    append(uv_triangles_, {corners[0].uv, corners[1].uv, corners[2].uv});
    if (!rules_.only_uv) append(mesh_.material_of_face, material_);
  }

  /// "v", "v/vt", "v//vn" or "v/vt/vn", each an index from 1 upwards, or from -1 backwards.
  Corner read_corner() {
    const std::string word = text_.read_word("a corner v/vt");
    const Integer v = parse_integer(word);
    if (!v.end || (*v.end != '/' && *v.end != '\0')) fail_corner(word);
    const auto position = std::uint32_t(resolved(v.value, positions_.size(), "v"));
    if (!rules_.only_uv && (*v.end == '\0' || v.end[1] == '/')) return {position, no_uv};
    if (*v.end == '\0') fail_corner(word);
    const Integer vt = parse_integer(v.end + 1);
    if (!vt.end || (*vt.end != '\0' && *vt.end != '/')) fail_corner(word);
    return {position, std::uint32_t(resolved(vt.value, uv_.size(), "vt"))};
  }

  std::uint64_t resolved(long long index, std::size_t count, const char* what) const {
    // Both fit in 32 bits and form one key.
    const auto have = static_cast<long long>(std::min<std::size_t>(count, no_uv));
    if (index == 0 || index > have || index < -have)
      text_.fail("a face names " + std::string(what) + " " + std::to_string(index) + " of " +
                 std::to_string(count));
    return static_cast<std::uint64_t>(index > 0 ? index - 1 : have + index);
  }

  [[noreturn]] void fail_corner(const std::string& word) const {
    text_.fail("\"" + word.substr(0, 40) + "\" is not a corner of the form " +
               (rules_.only_uv ? "v/vt or v/vt/vn" : "v, v/vt, v//vn or v/vt/vn"));
  }

  /// Makes a vertex of each pair of position and texture coordinate.
  void unify_vertices() {
    std::unordered_map<std::uint64_t, std::uint32_t> vertices;
    std::vector<glm::vec3> rgb = std::exchange(mesh_.rgb, {});
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
      for (int k = 0; k < 3; ++k) {
        std::uint32_t& corner = mesh_.triangles[t][k];
        const std::uint32_t place = uv_triangles_[t][k];
        const auto [found, is_new] =
            vertices.try_emplace(std::uint64_t(corner) << 32 | place,
                                 static_cast<std::uint32_t>(mesh_.positions.size()));
        if (is_new) {
          input_.take_memory(1, bytes_a_vertex, "the mesh");
          append(mesh_.positions, positions_[corner]);
          append(mesh_.uv, place == no_uv ? glm::vec2(0) : uv_[place]);
          if (!rgb.empty()) append(mesh_.rgb, rgb[corner]);
        }
        corner = found->second;
      }
  }

  /// A node of a map and its share of two generations of buckets, in bytes.
  static constexpr std::size_t bytes_a_vertex = 64;

  Input& input_;
  const ObjRules& rules_;
  TextScanner text_;
  std::vector<glm::vec3> positions_;
  std::vector<glm::vec2> uv_;
  std::vector<glm::uvec3> uv_triangles_;  // indices of uv_, or no_uv, of each triangle
  std::unordered_map<std::string, std::uint32_t> material_by_name_{{"", 0}};
  std::uint32_t material_ = 0;
  ObjMesh mesh_;
};

}  // namespace

ObjMesh read_obj(Input& input, const ObjRules& rules) { return ObjReader(input, rules).read(); }

}  // namespace tureen
