// Collects the primitives of a foreign glTF file in one soup.
#pragma once

#include <glm/mat4x4.hpp>
#include <map>
#include <string>
#include <vector>

#include "formats/gltf/gltf_document.hpp"
#include "formats/gltf/gltf_material.hpp"
#include "formats/read_options.hpp"
#include "scene/remark.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen {

/// What all soups of a file share.
struct GltfTally {
  std::size_t vertices = 0, faces = 0;  // sums, for the limit on instances
  /// Differences between the file and the rendering; remarks may repeat.
  std::vector<Remark> remarks = {};
  /// Map from an accessor's vertices to the soup's for the current primitive; other entries are
  /// "unused". It is kept, because a new map per primitive would take time proportional to the
  /// accessor.
  std::vector<std::uint32_t> renamed = {};
};

class GltfSoupBuilder {
 public:
  /// `colors` is srgb or linear, not automatic. `tally` must outlive this object.
  GltfSoupBuilder(GltfDocument& document, VertexColorSpace colors, GltfTally& tally)
      : document_(document), color_space_(colors), tally_(tally) {}

  /// Adds a primitive without splats, placed by `world_from_mesh`. `where` is its place in the
  /// JSON.
  void add_primitive(const tinygltf::Primitive& primitive, const std::string& where,
                     const glm::dmat4& world_from_mesh);

  /// VertexColors if no material has a texture, otherwise UvTextures.
  TriangleSoup finish();

  bool has_faces() const { return !soup_.triangles.empty(); }
  bool has_vertex_colors() const { return !vertex_colors_.empty(); }

 private:
  /// The vertices and faces of one primitive.
  struct Part {
    std::size_t first_vertex, vertices, first_face, faces;
    std::size_t material;  // in materials_
  };

  std::vector<glm::uvec3> triangles_of(const tinygltf::Primitive& primitive,
                                       const std::string& where, std::size_t vertices);
  void add_positions(int accessor, const std::string& where, const glm::dmat4& world_from_mesh,
                     const std::vector<std::uint32_t>& used);
  void add_normals(int accessor, const std::string& where, const glm::dmat4& world_from_mesh,
                   const std::vector<std::uint32_t>& used);
  void add_colors(int accessor, const std::string& where, const std::vector<std::uint32_t>& used);
  void add_uv(const tinygltf::Primitive& primitive, const GltfMaterial& material,
              const std::string& where, const std::vector<std::uint32_t>& used);
  std::size_t material(int index);
  glm::vec4 display_color(const glm::vec4& stored, const glm::dvec4& factor) const;
  VertexColors as_vertex_colors() const;
  UvTextures as_uv_textures();

  GltfDocument& document_;
  VertexColorSpace color_space_;
  GltfTally& tally_;
  TriangleSoup soup_;
  std::vector<Part> parts_;
  std::vector<GltfMaterial> materials_;
  std::map<int, std::size_t> material_index_;  // from the file's indices, including -1
  std::vector<glm::vec4> vertex_colors_;       // as stored; empty until the first
  std::vector<glm::vec2> uv_;                  // empty until the first
};

}  // namespace tureen
