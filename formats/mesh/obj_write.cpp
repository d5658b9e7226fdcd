#include <array>
#include <charconv>
#include <string>
#include <utility>

#include "base/output.hpp"
#include "formats/mesh/obj.hpp"
#include "formats/mesh/plain_mesh.hpp"

namespace tureen {

namespace {

/// The shortest text that reads back as this float, after a space.
void append_number(std::string& line, float value) {
  std::array<char, 32> text;
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
  line += ' ';
  line.append(text.data(), end);
}

}  // namespace

std::vector<std::string> write_obj(const Scene& scene, const std::filesystem::path& path) {
  PlainMesh mesh(scene, "OBJ", obj_up);
  const TriangleSoup& soup = mesh.soup();
  const auto& rgba = mesh.face_rgba() ? *mesh.face_rgba() : *mesh.vertex_rgba();
  bool is_opaque = true;
  Output output(path);
  output.write(std::string_view("# colours of vertices follow their coordinates\n"));
  const auto write_vertex = [&](std::uint32_t vertex, const glm::vec4& color) {
    std::string line = "v";
    for (int k = 0; k < 3; ++k) append_number(line, soup.positions[vertex][k]);
    for (int k = 0; k < 3; ++k) append_number(line, color[k]);
    is_opaque = is_opaque && color.a >= 1;
    output.write(std::string_view(line + "\n"));
  };
  if (mesh.vertex_rgba()) {
    for (std::size_t i = 0; i < soup.positions.size(); ++i) write_vertex(std::uint32_t(i), rgba[i]);
  } else {
    for (std::size_t t = 0; t < soup.triangles.size(); ++t)
      for (int k = 0; k < 3; ++k) write_vertex(soup.triangles[t][k], rgba[t]);
  }
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    std::string line = "f";
    for (int k = 0; k < 3; ++k) {
      const std::size_t vertex = mesh.vertex_rgba() ? soup.triangles[t][k] : 3 * t + std::size_t(k);
      line += " " + std::to_string(vertex + 1);
    }
    output.write(std::string_view(line + "\n"));
  }
  output.commit();
  if (!is_opaque) mesh.lost.push_back("OBJ holds no opacity of vertices: all are opaque.");
  return std::move(mesh.lost);
}

}  // namespace tureen
