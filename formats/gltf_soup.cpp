#include "formats/gltf_soup.hpp"

#include <algorithm>
#include <limits>

#include "formats/gltf_accessor.hpp"
#include "soup/srgb.hpp"

namespace tureen {

namespace {

constexpr std::uint32_t unused = std::numeric_limits<std::uint32_t>::max();

/// Strips and fans as lists: triangle i of a strip turns around where i is odd, so that all face
/// the same way.
std::vector<glm::uvec3> assembled(const std::vector<std::uint32_t>& corners, int mode) {
  std::vector<glm::uvec3> triangles;
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    triangles.reserve(corners.size() / 3);
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
      triangles.emplace_back(corners[i], corners[i + 1], corners[i + 2]);
    return triangles;
  }
  for (std::size_t i = 0; i + 2 < corners.size(); ++i) {
    if (mode == TINYGLTF_MODE_TRIANGLE_FAN)
      triangles.emplace_back(corners[0], corners[i + 1], corners[i + 2]);
    else
      triangles.emplace_back(corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]);
  }
  return triangles;
}

}  // namespace

void GltfSoupBuilder::add_mesh(int index, const glm::dmat4& world_from_mesh) {
  const auto& meshes = document_.model().meshes;
  if (index < 0 || std::size_t(index) >= meshes.size())
    document_.fail("meshes", "there is no mesh " + std::to_string(index) + " of " +
                                 std::to_string(meshes.size()));
  const tinygltf::Mesh& mesh = meshes[std::size_t(index)];
  for (std::size_t i = 0; i < mesh.primitives.size(); ++i)
    add_primitive(mesh.primitives[i],
                  "meshes[" + std::to_string(index) + "].primitives[" + std::to_string(i) + "]",
                  world_from_mesh);
}

std::vector<glm::uvec3> GltfSoupBuilder::triangles_of(const tinygltf::Primitive& primitive,
                                                      const std::string& where,
                                                      std::size_t vertices) {
  std::vector<std::uint32_t> corners;
  if (primitive.indices >= 0) {
    corners = read_index_accessor(document_, primitive.indices, vertices);
  } else {
    corners.resize(vertices);
    for (std::size_t i = 0; i < vertices; ++i) corners[i] = std::uint32_t(i);
  }
  if (primitive.mode == TINYGLTF_MODE_TRIANGLES && corners.size() % 3 != 0)
    notes.push_back(where + ": " + std::to_string(corners.size()) +
                    " corners are no whole number of triangles; the rest is dropped");
  return assembled(corners, primitive.mode);
}

void GltfSoupBuilder::add_primitive(const tinygltf::Primitive& primitive, const std::string& where,
                                    const glm::dmat4& world_from_mesh) {
  if (primitive.mode >= TINYGLTF_MODE_POINTS && primitive.mode <= TINYGLTF_MODE_LINE_STRIP) {
    notes.push_back("points and lines are not drawn");
    return;
  }
  if (primitive.mode < TINYGLTF_MODE_TRIANGLES || primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN)
    document_.fail(where, "mode " + std::to_string(primitive.mode) + " is unknown");
  const auto position = primitive.attributes.find("POSITION");
  if (position == primitive.attributes.end()) {
    notes.push_back("primitives without POSITION are not drawn");
    return;
  }
  if (!primitive.targets.empty()) notes.push_back("morph targets are not applied");

  const FloatAccessor positions = read_float_accessor(document_, position->second, {3});
  std::vector<glm::uvec3> triangles = triangles_of(primitive, where, positions.count);

  // Only the vertices that this primitive uses, in order: exporters let many primitives draw on
  // one large accessor.
  std::vector<std::uint32_t> renamed(positions.count, unused), used;
  for (const glm::uvec3& triangle : triangles)
    for (int k = 0; k < 3; ++k) renamed[triangle[k]] = 0;
  for (std::size_t i = 0; i < renamed.size(); ++i)
    if (renamed[i] != unused) {
      renamed[i] = std::uint32_t(soup_.positions.size() + used.size());
      used.push_back(std::uint32_t(i));
    }
  const std::size_t total = soup_.positions.size() + used.size();
  if (total > document_.vertex_budget() || total >= unused ||
      soup_.triangles.size() + triangles.size() > 4 * document_.vertex_budget())
    document_.fail(where, "the scene's nodes repeat its meshes to more than " +
                              std::to_string(document_.vertex_budget()) + " vertices");

  const Part part{soup_.positions.size(), used.size(), soup_.triangles.size(), triangles.size(),
                  material(primitive.material)};
  parts_.push_back(part);
  soup_.positions.reserve(total);
  for (const std::uint32_t v : used) {
    const float* p = &positions.values[3 * std::size_t(v)];
    soup_.positions.emplace_back(world_from_mesh * glm::dvec4(p[0], p[1], p[2], 1.0));
  }
  soup_.triangles.reserve(soup_.triangles.size() + triangles.size());
  for (const glm::uvec3& t : triangles)
    soup_.triangles.emplace_back(renamed[t.x], renamed[t.y], renamed[t.z]);

  const auto color = primitive.attributes.find("COLOR_0");
  if (color != primitive.attributes.end()) {
    if (accessor_count(document_, color->second) != positions.count)
      document_.fail(where + ".attributes.COLOR_0", "has not as many elements as POSITION");
    add_colors(color->second, where, used);
  }
  add_uv(primitive, materials_[part.material], where, used);
}

void GltfSoupBuilder::add_colors(int accessor, const std::string& where,
                                 const std::vector<std::uint32_t>& used) {
  const FloatAccessor colors = read_float_accessor(document_, accessor, {3, 4});
  if (document_.model().accessors[std::size_t(accessor)].componentType !=
          TINYGLTF_COMPONENT_TYPE_FLOAT &&
      !document_.model().accessors[std::size_t(accessor)].normalized)
    document_.fail(where + ".attributes.COLOR_0", "holds integers that are not normalised");
  const std::size_t first = soup_.positions.size() - used.size();
  vertex_colors_.resize(first, glm::vec4(1.0f));
  for (const std::uint32_t v : used) {
    const float* c = &colors.values[std::size_t(v) * std::size_t(colors.components)];
    vertex_colors_.emplace_back(c[0], c[1], c[2], colors.components == 4 ? c[3] : 1.0f);
  }
}

void GltfSoupBuilder::add_uv(const tinygltf::Primitive& primitive, const GltfMaterial& material,
                             const std::string& where, const std::vector<std::uint32_t>& used) {
  if (material.image < 0) return;
  const std::string name = "TEXCOORD_" + std::to_string(material.texture_coordinate);
  const auto attribute = primitive.attributes.find(name);
  if (attribute == primitive.attributes.end())
    document_.fail(where, "its material wants " + name + ", which it lacks");
  const FloatAccessor uv = read_float_accessor(document_, attribute->second, {2});
  const std::size_t first = soup_.positions.size() - used.size();
  uv_.resize(first, glm::vec2(0.0f));
  for (const std::uint32_t v : used) {
    if (v >= uv.count)
      document_.fail(where + ".attributes." + name, "has not as many elements as POSITION");
    uv_.emplace_back(material.uv_transform * glm::dvec3(uv.values[2 * std::size_t(v)],
                                                        uv.values[2 * std::size_t(v) + 1], 1.0));
  }
}

std::size_t GltfSoupBuilder::material(int index) {
  const auto [entry, fresh] = material_index_.try_emplace(index, materials_.size());
  if (fresh) materials_.push_back(read_gltf_material(document_, index, notes));
  return entry->second;
}

/// glTF multiplies in linear light. Colours that are display-referred and not changed by a factor
/// stay as they are to the bit.
glm::vec4 GltfSoupBuilder::display_color(const glm::vec4& stored, const glm::dvec4& factor) const {
  const bool srgb = color_space_ == VertexColorSpace::srgb;
  const glm::vec4 alpha(0, 0, 0, float(double(stored.w) * factor.w));
  if (srgb && glm::dvec3(factor) == glm::dvec3(1.0))
    return glm::vec4(glm::vec3(stored), 0.0f) + alpha;
  const glm::dvec3 linear = srgb ? linear_from_srgb(glm::dvec3(stored)) : glm::dvec3(stored);
  return glm::vec4(glm::vec3(srgb_from_linear(linear * glm::dvec3(factor))), 0.0f) + alpha;
}

VertexColors GltfSoupBuilder::as_vertex_colors() const {
  VertexColors colors;
  colors.rgba.reserve(soup_.positions.size());
  for (const Part& part : parts_) {
    const GltfMaterial& material = materials_[part.material];
    const glm::vec4 constant = glm::vec4(glm::vec3(srgb_from_linear(glm::dvec3(material.factor))),
                                         float(material.factor.w));
    for (std::size_t v = part.first_vertex; v < part.first_vertex + part.vertices; ++v) {
      glm::vec4 rgba =
          vertex_colors_.empty() ? constant : display_color(vertex_colors_[v], material.factor);
      // Moved, not scaled: an alpha that equals the cutoff becomes alpha_threshold exactly, and
      // what is interpolated crosses the one where it crossed the other.
      rgba.w = material.masked ? rgba.w - material.cutoff + alpha_threshold : 1.0f;
      colors.rgba.push_back(rgba);
    }
  }
  return colors;
}

UvTextures GltfSoupBuilder::as_uv_textures() {
  UvTextures textures;
  uv_.resize(soup_.positions.size(), glm::vec2(0.0f));
  textures.uv = std::move(uv_);
  textures.material_of_face.reserve(soup_.triangles.size());
  for (const Part& part : parts_)
    textures.material_of_face.insert(textures.material_of_face.end(), part.faces,
                                     std::uint32_t(part.material));
  for (const glm::vec4& stored : vertex_colors_)
    textures.vertex_rgba.push_back(display_color(stored, glm::dvec4(1.0)));

  bool multiplied = !vertex_colors_.empty();
  std::map<int, std::uint32_t> image_index;
  for (const GltfMaterial& material : materials_) {
    UvMaterial& made = textures.materials.emplace_back();
    if (material.image >= 0) {
      const auto [entry, fresh] =
          image_index.try_emplace(material.image, std::uint32_t(textures.images.size()));
      if (fresh) textures.images.push_back(document_.image(material.image));
      made.images = {entry->second};
      multiplied = multiplied || glm::dvec3(material.factor) != glm::dvec3(1.0);
    }
    made.wrap_u = material.wrap_u;
    made.wrap_v = material.wrap_v;
    made.filter = material.filter;
    made.factor = glm::vec4(glm::vec3(srgb_from_linear(glm::dvec3(material.factor))),
                            float(material.factor.w));
    made.mask_threshold = material.masked ? material.cutoff : 0.0f;
  }
  if (multiplied)
    notes.push_back(
        "texture, factor and vertex colour are multiplied as display-referred values, which comes "
        "near to the product in linear light that glTF asks for, but is not the same");
  return textures;
}

TriangleSoup GltfSoupBuilder::finish() {
  if (has_vertex_colors()) vertex_colors_.resize(soup_.positions.size(), glm::vec4(1.0f));
  const bool textured = std::any_of(materials_.begin(), materials_.end(),
                                    [](const GltfMaterial& m) { return m.image >= 0; });
  if (textured)
    soup_.appearance = as_uv_textures();
  else
    soup_.appearance = as_vertex_colors();
  return std::move(soup_);
}

}  // namespace tureen
