// What the plain mesh formats (OFF, PLY) have in common: polygons become triangles, colours become
// one appearance; and the way back, from any scene to coloured triangles, with what that loses.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/input.hpp"
#include "formats/scene_file.hpp"
#include "scene/scene.hpp"

namespace tureen {

/// Collects vertices and polygons in file order. A reader fills `positions` and, where the file has
/// them, `vertex_rgba`, and reports polygons corner by corner, so that none is ever held whole.
/// What it allocates counts against the input's budget.
class MeshBuilder {
 public:
  explicit MeshBuilder(Input& input) : input_(input) {}

  /// Faces without a colour of their own, and whole meshes without any.
  static constexpr glm::vec4 no_color{0.8f, 0.8f, 0.8f, 1.0f};

  std::vector<glm::vec3> positions;
  std::vector<glm::vec4> vertex_rgba;  // empty, or one a vertex when finish() is called

  void reserve_vertices(std::uint64_t count);
  void reserve_colors_of_vertices(std::uint64_t count);
  void reserve_faces(std::uint64_t count);

  void begin_face() { corners_ = 0; }
  /// The next corner; the caller has checked that the vertex will exist.
  void add_corner(std::uint32_t vertex);
  /// Ends the polygon: a fan around its first corner. Fewer than three corners draw nothing.
  void end_face();
  /// Ends the polygon and gives all its triangles this colour.
  void end_face(const glm::vec4& rgba);
  /// One triangle of a strip, without a colour.
  void add_triangle(glm::uvec3 triangle);

  std::size_t triangle_count() const { return triangles_.size(); }
  /// The colours of the triangles so far; empty where no face had one. Not to be made longer.
  std::vector<glm::vec4>& face_rgba() { return face_rgba_; }

  /// Clamps every colour to [0, 1] (NaN becomes 0), chooses the appearance (vertex colours before
  /// face colours before grey) and writes a note for whatever that changed or left out.
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
  std::uint64_t polygons_ = 0;      // of more than three corners
  std::uint64_t too_small_ = 0;     // of fewer than three
  std::uint64_t uncolored_ = 0;     // triangles among colored ones
};

/// Calls `progress` with the fraction done, once every 65,536 calls.
class ProgressMeter {
 public:
  explicit ProgressMeter(const ReadOptions& options) : progress_(options.progress) {}
  template <class Fraction>
  void step(Fraction&& fraction) {
    if (++steps_ % 65536 == 0 && progress_) progress_(fraction());
  }

 private:
  const std::function<void(double)>& progress_;
  std::uint64_t steps_ = 0;
};

/// A scene as coloured triangles: its own soup where that has FaceColors or VertexColors, otherwise
/// a copy of its triangles with the mean colour of each face (scene/edit/mean_color.hpp), and a
/// sentence.
class PlainMesh {
 public:
  /// `format` names the format in the sentences. Keeps a reference to the scene where it can.
  PlainMesh(const Scene& scene, const std::string& format);
  PlainMesh(Scene&&, const std::string&) = delete;
  PlainMesh(const PlainMesh&) = delete;
  PlainMesh& operator=(const PlainMesh&) = delete;

  const TriangleSoup& soup() const { return *soup_; }
  /// Null where the other one is there.
  const std::vector<glm::vec4>* face_rgba() const;
  const std::vector<glm::vec4>* vertex_rgba() const;
  /// What the format cannot hold, a sentence each.
  std::vector<std::string> lost;

 private:
  void use_mean_colors(const std::string& format);

  std::optional<TriangleSoup> own_;
  const TriangleSoup* soup_ = nullptr;  // the scene's, or own_
};

/// The up axis of files that know none.
inline constexpr glm::vec3 assumed_up{0.0f, 0.0f, 1.0f};

/// Whether every component of every colour is byte / 255 for some byte.
bool are_bytes(const std::vector<glm::vec4>& rgba);

}  // namespace tureen
