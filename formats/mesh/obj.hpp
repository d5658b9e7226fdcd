// Wavefront OBJ: polygons with texture coordinates, colours of vertices and names of materials.
//
// Supported: v x y z [r g b], vt, f with any number of corners and negative indices, usemtl,
// mtllib, and lines that continue after a backslash in f. Groups and objects are one mesh.
// Materials: formats/mesh/mtl.hpp. Not supported: normals, points, lines and curves; their lines
// are skipped.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "base/input.hpp"
#include "formats/read_options.hpp"
#include "scene/scene.hpp"

namespace tureen {

/// The vertices are those of the file; with texture coordinates each distinct pair of v and vt in a
/// face is a vertex, in the order of first use.
struct ObjMesh {
  std::vector<glm::vec3> positions;  // one a vertex
  std::vector<glm::vec2> uv;         // empty, or one a vertex; v grows upwards; (0, 0) without vt
  std::vector<glm::vec3> rgb;        // empty, or one a vertex; grey (0.8) where it has none
  std::vector<glm::uvec3> triangles;
  std::vector<std::uint32_t> material_of_face;  // one a triangle: an index of `materials`
  /// Names, in the order of first use. The first, "", is that of faces without a material.
  std::vector<std::string> materials{""};
  std::vector<std::string> libraries;  // of mtllib, each once
  std::uint64_t polygons = 0;          // with more than three corners
  std::uint64_t small_faces = 0;       // with fewer than three: skipped
  std::uint64_t points_and_lines = 0;  // skipped
};

struct ObjRules {
  /// For the shapes of MobileNeRF: each corner needs a vt and each face three corners; colours and
  /// materials are skipped.
  bool only_uv = false;
};

/// Polygons become fans; negative indices count back from the last v or vt so far. Throws
/// InputError with the line for an invalid number and an index out of range.
ObjMesh read_obj(Input& input, const ObjRules& rules = {});

/// A soup with VertexColors or FaceColors, or UvTextures if a material that is used has a texture.
/// Libraries and textures lie in the file's folder; what is missing there or damaged costs the
/// colours of its materials, with a remark. Values are display-referred. Up is y. Throws
/// InputError.
Scene read_obj(const std::filesystem::path& path, const ReadOptions& options = {});

/// The up axis of files that do not store one, as Blender and Maya write them.
inline constexpr glm::vec3 obj_up{0.0f, 1.0f, 0.0f};

/// Triangles with a colour for each vertex, after its coordinates (as MeshLab, Blender and others
/// read them); faces with a colour of their own get their own vertices. Positions and colours read
/// back bit for bit. Returns the losses. Throws UsageError for splats, OutputError.
std::vector<std::string> write_obj(const Scene& scene, const std::filesystem::path& path);

}  // namespace tureen
