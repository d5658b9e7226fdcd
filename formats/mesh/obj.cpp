#include "formats/mesh/obj.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "base/decimal.hpp"
#include "base/text_scanner.hpp"

namespace tureen {

namespace {

class ObjReader {
 public:
  explicit ObjReader(Input& input) : input_(input), text_(input, {.comment = '#'}) {}

  ObjMesh read() {
    while (text_.next_content()) {
      const std::string_view keyword = text_.peek(3);
      if (keyword == "v") {
        text_.skip(1);
        const float x = text_.read_float("x"), y = text_.read_float("y");
        append(positions_, {x, y, text_.read_float("z")});
      } else if (keyword == "vt") {
        text_.skip(2);
        const float u = text_.read_float("u");
        append(uv_, {u, text_.read_float("v")});
      } else if (keyword == "f") {
        text_.skip(1);
        read_face();
      }
      if (!text_.next_line()) break;
    }
    return std::move(mesh_);
  }

 private:
  template <class T>
  void append(std::vector<T>& values, const T& value) {
    if (values.size() == values.capacity()) input_.make_room_in(values, 1, "the mesh");
    values.push_back(value);
  }

  void read_face() {
    std::uint32_t first = 0, previous = 0;
    int corners = 0;
    for (; !text_.at_line_end(); ++corners) {
      const std::uint32_t vertex = read_corner();
      if (corners >= 2) append(mesh_.triangles, {first, previous, vertex});
      if (corners == 0) first = vertex;
      previous = vertex;
    }
    if (corners < 3) text_.fail("a face of " + std::to_string(corners) + " corners");
  }

  /// "v/vt" or "v/vt/vn", each an index from 1 upwards, or from -1 backwards.
  std::uint32_t read_corner() {
    const std::string word = text_.read_word("a corner v/vt");
    const Integer v = parse_integer(word);
    if (!v.end || *v.end != '/') fail_corner(word);
    const Integer vt = parse_integer(v.end + 1);
    if (!vt.end || (*vt.end != '\0' && *vt.end != '/')) fail_corner(word);
    const std::uint64_t position = resolved(v.value, positions_.size(), "v");
    const std::uint64_t place = resolved(vt.value, uv_.size(), "vt");
    const auto [found, is_new] = vertices_.try_emplace(
        position << 32 | place, static_cast<std::uint32_t>(mesh_.positions.size()));
    if (is_new) {
      input_.take_memory(1, bytes_a_vertex, "the mesh");
      append(mesh_.positions, positions_[position]);
      append(mesh_.uv, uv_[place]);
    }
    return found->second;
  }

  std::uint64_t resolved(long long index, std::size_t count, const char* what) const {
    // Both fit in 32 bits and form one key.
    const auto have = static_cast<long long>(
        std::min<std::size_t>(count, std::numeric_limits<std::uint32_t>::max()));
    if (index == 0 || index > have || index < -have)
      text_.fail("a face names " + std::string(what) + " " + std::to_string(index) + " of " +
                 std::to_string(count));
    return static_cast<std::uint64_t>(index > 0 ? index - 1 : have + index);
  }

  [[noreturn]] void fail_corner(const std::string& word) const {
    text_.fail("\"" + word.substr(0, 40) + "\" is not a corner of the form v/vt or v/vt/vn");
  }

  /// A node of the map and its share of two generations of buckets, in bytes.
  static constexpr std::size_t bytes_a_vertex = 64;

  Input& input_;
  TextScanner text_;
  std::vector<glm::vec3> positions_;
  std::vector<glm::vec2> uv_;
  std::unordered_map<std::uint64_t, std::uint32_t> vertices_;
  ObjMesh mesh_;
};

}  // namespace

ObjMesh read_obj(Input& input) { return ObjReader(input).read(); }

}  // namespace tureen
