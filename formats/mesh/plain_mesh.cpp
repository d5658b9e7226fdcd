#include "formats/mesh/plain_mesh.hpp"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <utility>

#include "base/decimal_text.hpp"
#include "formats/common/format_remarks.hpp"
#include "formats/mesh/mesh_remarks.hpp"
#include "image/quantise.hpp"
#include "scene/edit/baked_transform.hpp"
#include "scene/edit/mean_color.hpp"
#include "scene/edit/moved_normals.hpp"
#include "scene/edit/opaque_windows.hpp"
#include "scene/similarity.hpp"

namespace tureen {

namespace {

/// Clamps every component to [0, 1]. Returns the number of changed components.
std::uint64_t clamp_colors(std::vector<glm::vec4>& rgba) {
  std::uint64_t clamped = 0;
  for (glm::vec4& color : rgba)
    for (int c = 0; c < 4; ++c) {
      if (color[c] >= 0.0f && color[c] <= 1.0f) continue;
      color[c] = color[c] > 1.0f ? 1.0f : 0.0f;  // NaN compares false and becomes 0
      ++clamped;
    }
  return clamped;
}

}  // namespace

void MeshBuilder::reserve_vertices(std::uint64_t count) {
  input_.make_room_in(positions, count, "the vertices");
}

void MeshBuilder::reserve_colors_of_vertices(std::uint64_t count) {
  input_.make_room_in(vertex_rgba, count, "the colours of the vertices");
}

void MeshBuilder::reserve_normals(std::uint64_t count) {
  input_.make_room_in(normals, count, "the normals");
}

void MeshBuilder::reserve_faces(std::uint64_t count) {
  input_.make_room_in(triangles_, count, "the faces");
}

void MeshBuilder::color_faces(std::size_t count, const glm::vec4& rgba) {
  if (count > face_rgba_.capacity())
    input_.make_room_in(face_rgba_, count - face_rgba_.size(), "the colours of the faces");
  face_rgba_.resize(count, rgba);
}

void MeshBuilder::add_corner(std::uint32_t vertex) {
  if (corners_ == 0) {
    first_triangle_ = triangles_.size();
    fan_[0] = vertex;
  } else if (corners_ >= 2) {
    add({fan_[0], fan_[1], vertex});
  }
  fan_[1] = vertex;
  ++corners_;
}

void MeshBuilder::end_face() {
  if (corners_ < 3) ++too_small_;
  if (corners_ > 3) ++polygons_;
  if (face_rgba_.empty()) return;
  uncolored_ += triangles_.size() - face_rgba_.size();
  color_faces(triangles_.size(), no_color);
}

void MeshBuilder::end_face(const glm::vec4& rgba) {
  if (corners_ < 3) {
    ++too_small_;
    return;
  }
  if (corners_ > 3) ++polygons_;
  if (face_rgba_.empty()) {
    // The first colour: the triangles before it had none.
    input_.make_room_in(face_rgba_, triangles_.capacity(), "the colours of the faces");
    face_rgba_.resize(first_triangle_, no_color);
    uncolored_ = first_triangle_;
  }
  color_faces(triangles_.size(), rgba);
}

void MeshBuilder::add_triangle(glm::uvec3 triangle) {
  add(triangle);
  corners_ = 3;
  end_face();
}

Scene MeshBuilder::finish(std::string name, std::string source) {
  Scene scene;
  scene.info.name = std::move(name);
  scene.info.up = assumed_up;
  scene.info.up_is_assumed = true;
  std::vector<Remark>& remarks = scene.info.remarks;
  remarks.push_back({&remarks::up_unknown_to_format, {{"format", source}}});
  if (polygons_ > 0) remarks.push_back({&remarks::polygons_split, {{"polygons", polygons_}}});
  if (too_small_ > 0) remarks.push_back({&remarks::small_faces_dropped, {{"faces", too_small_}}});

  const std::uint64_t clamped = clamp_colors(vertex_rgba) + clamp_colors(face_rgba_);
  if (clamped > 0)
    remarks.push_back({&remarks::color_components_clamped, {{"components", clamped}}});

  TriangleSoup soup;
  soup.positions = std::move(positions);
  soup.triangles = std::move(triangles_);
  soup.normals = std::move(normals);
  if (!vertex_rgba.empty()) {
    if (!face_rgba_.empty()) remarks.push_back({&remarks::face_colors_dropped});
    soup.appearance = VertexColors{std::move(vertex_rgba)};
  } else {
    if (face_rgba_.empty())
      remarks.push_back({&remarks::colors_missing});
    else if (uncolored_ > 0)
      remarks.push_back({&remarks::face_colors_missing, {{"triangles", uncolored_}}});
    color_faces(soup.triangles.size(), no_color);
    soup.appearance = FaceColors{std::move(face_rgba_)};
  }
  scene.layers.push_back({.primitives = std::move(soup)});
  scene.info.source = std::move(source);
  return scene;
}

PlainMesh::PlainMesh(const Scene& scene, const std::string& format, const glm::vec3& up) {
  const Layer& layer = only_layer(scene);
  if (const auto* splats = std::get_if<Splats>(&layer.primitives)) {
    if (!std::holds_alternative<TriangleWindows>(splats->kernel))
      throw UsageError(format + " holds triangles; this scene holds " + kernel_name(splats->kernel),
                       "write .glb or .ply, or another format of splats");
    OpaqueResult opaque = to_opaque(*splats);
    lost = described(opaque.remarks);
    own_ = std::move(opaque.soup);
    soup_ = &*own_;
  } else {
    soup_ = &std::get<TriangleSoup>(layer.primitives);
  }
  if (!face_rgba() && !vertex_rgba()) use_mean_colors(format);
  if (layer.world_from_layer != glm::dmat4(1.0)) use_world_positions(layer, format);
  if (scene.info.up != up)
    lost.push_back(format + " stores no up axis: readers assume " + axis_name(glm::dvec3(up)) +
                   ", but that of the scene is " + axis_name(glm::dvec3(scene.info.up)) +
                   ", so they show it tilted.");
  if (scene.info.background != glm::vec3(0.0f))
    lost.push_back(format + " holds no background colour.");
  if (!scene.cameras.empty()) lost.push_back(format + " holds no cameras.");
  if (scene.first_view) lost.push_back(format + " holds no first view.");
  if (layer.material) lost.push_back(format + " holds no mirrors and no glass.");
}

void PlainMesh::use_mean_colors(const std::string& format) {
  FaceColors colors;
  colors.rgba.reserve(soup_->triangles.size());
  for (const glm::vec3& color : mean_colors(*soup_)) colors.rgba.emplace_back(color, 1.0f);
  lost.push_back(format + " cannot hold " + appearance_name(soup_->appearance) +
                 ": each face gets its mean colour, opaque.");
  if (own_) {
    own_->appearance = std::move(colors);
  } else {
    own_ = TriangleSoup{soup_->positions, soup_->triangles, std::move(colors), soup_->normals};
    soup_ = &*own_;
  }
}

void PlainMesh::use_world_positions(const Layer& layer, const std::string& format) {
  // The colours are means over directions by now, so the transform does not change them.
  if (!own_) own_ = *soup_;
  soup_ = &*own_;
  move_normals(own_->normals, glm::dmat3(layer.world_from_layer));
  const double radius = bounds(*own_).radius() * glm::length(glm::dvec3(layer.world_from_layer[0]));
  double error = 0;
  for (glm::vec3& position : own_->positions) {
    const glm::dvec3 exact(layer.world_from_layer * glm::dvec4(position, 1.0));
    position = glm::vec3(exact);
    const glm::dvec3 rounded = glm::abs(glm::dvec3(position) - exact);
    error = std::max({error, rounded.x, rounded.y, rounded.z});
  }
  // A millionth of the radius is a hundredth of a pixel in an image with 20,000 rows.
  if (error > 1e-6 * radius)
    lost.push_back(
        format + " holds positions with 24 bits: in world coordinates they are rounded by up to " +
        short_decimal(error, 2) + " units.");
  if (is_translation(layer)) return;
  // Other programs take the side of a triangle from the order of its corners; a mirror swaps it.
  if (glm::determinant(glm::dmat3(layer.world_from_layer)) < 0)
    for (glm::uvec3& triangle : own_->triangles) std::swap(triangle.y, triangle.z);
  lost.push_back(format +
                 " holds no transform: the layer's rotation, scale or mirror is applied to the "
                 "positions, which rounds them.");
}

const std::vector<glm::vec4>* PlainMesh::face_rgba() const {
  const auto* colors = std::get_if<FaceColors>(&soup_->appearance);
  return colors ? &colors->rgba : nullptr;
}

const std::vector<glm::vec4>* PlainMesh::vertex_rgba() const {
  const auto* colors = std::get_if<VertexColors>(&soup_->appearance);
  return colors ? &colors->rgba : nullptr;
}

bool are_bytes(const std::vector<glm::vec4>& rgba) {
  return std::all_of(rgba.begin(), rgba.end(), [](const glm::vec4& color) {
    for (int c = 0; c < 4; ++c)
      if (color[c] != float(quantised_unit(color[c])) / 255.0f) return false;
    return true;
  });
}

}  // namespace tureen
