// Code shared by the plain mesh formats (OFF, PLY). Reading converts polygons to triangles and
// colours to one appearance. Writing converts any scene to coloured triangles and reports the
// losses.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/input.hpp"
#include "scene/scene.hpp"

namespace tureen {

/// The up axis of files that do not store one.
inline constexpr glm::vec3 assumed_up{0.0f, 0.0f, 1.0f};

/// Collects vertices and polygons in file order. A reader fills `positions` and, if the file has
/// them, `vertex_rgba`. It passes polygons corner by corner, so that no polygon is stored whole.
/// Allocations count against the input's budget.
class MeshBuilder {
 public:
  explicit MeshBuilder(Input& input) : input_(input) {}

  /// The colour of faces without their own, and of meshes without any.
  static constexpr glm::vec4 no_color{0.8f, 0.8f, 0.8f, 1.0f};

  std::vector<glm::vec3> positions;
  std::vector<glm::vec4> vertex_rgba;  // empty, or one a vertex when finish() is called
  std::vector<glm::vec3> normals;      // the same

  void reserve_vertices(std::uint64_t count);
  void reserve_colors_of_vertices(std::uint64_t count);
  void reserve_normals(std::uint64_t count);
  void reserve_faces(std::uint64_t count);

  void begin_face() { corners_ = 0; }
  /// Adds a corner; the caller has checked that the vertex will exist.
  void add_corner(std::uint32_t vertex);
  /// Ends the polygon: a fan around its first corner. Polygons with fewer than three corners are
  /// dropped.
  void end_face();
  /// Ends the polygon and assigns this colour to all its triangles.
  void end_face(const glm::vec4& rgba);
  /// One triangle of a strip, without a colour.
  void add_triangle(glm::uvec3 triangle);

  std::size_t triangle_count() const { return triangles_.size(); }
  /// The colours of the triangles so far; empty if no face had one. The caller must not append to
  /// it.
  std::vector<glm::vec4>& face_rgba() { return face_rgba_; }

  /// Clamps every colour to [0, 1] (NaN becomes 0). Chooses the appearance: vertex colours, else
  /// face colours, else grey. Adds a remark for each change or loss.
  Scene finish(std::string name, std::string source);

 private:
  void add(const glm::uvec3& triangle) {
    if (triangles_.size() == triangles_.capacity()) input_.make_room_in(triangles_, 1, "the faces");
    triangles_.push_back(triangle);
  }
  void color_faces(std::size_t count, const glm::vec4& rgba);

  Input& input_;
  std::vector<glm::uvec3> triangles_;
  std::vector<glm::vec4> face_rgba_;
  std::uint64_t corners_ = 0;
  std::size_t first_triangle_ = 0;  // of the current face
  glm::uvec3 fan_{0};               // first corner, previous corner, unused
  std::uint64_t polygons_ = 0;      // with more than three corners
  std::uint64_t too_small_ = 0;     // with fewer than three
  std::uint64_t uncolored_ = 0;     // uncoloured triangles in a coloured mesh
};

/// A scene as coloured triangles: its own soup if that has FaceColors or VertexColors. Otherwise a
/// copy of its triangles with the mean colour of each face (scene/edit/mean_color.hpp), and a
/// sentence in `lost`. Positions and normals are in world coordinates; a sentence reports a
/// rotation, scale or mirror, and rounding by more than a millionth of the mesh's radius.
class PlainMesh {
 public:
  /// `format` is the format's name in the sentences, `up` the axis that its readers assume. Keeps a
  /// reference to the scene if possible.
  /// Throws UsageError for any number of layers other than one.
  PlainMesh(const Scene& scene, const std::string& format, const glm::vec3& up = assumed_up);
  PlainMesh(Scene&&, const std::string&) = delete;
  PlainMesh(const PlainMesh&) = delete;
  PlainMesh& operator=(const PlainMesh&) = delete;

  const TriangleSoup& soup() const { return *soup_; }
  /// Null if the other one exists.
  const std::vector<glm::vec4>* face_rgba() const;
  const std::vector<glm::vec4>* vertex_rgba() const;
  /// One sentence for each loss of the format.
  std::vector<std::string> lost;

 private:
  void use_mean_colors(const std::string& format);
  void use_world_positions(const Layer& layer, const std::string& format);

  std::optional<TriangleSoup> own_;
  const TriangleSoup* soup_ = nullptr;  // the scene's, or own_
};

/// Whether every component of every colour is byte / 255 for some byte.
bool are_bytes(const std::vector<glm::vec4>& rgba);

}  // namespace tureen
