#include "formats/gltf/gltf_soup.hpp"

#include <algorithm>
#include <limits>
#include <optional>

#include "formats/gltf/gltf_accessor.hpp"
#include "formats/gltf/gltf_remarks.hpp"
#include "image/srgb.hpp"
#include "scene/edit/moved_normals.hpp"

namespace tureen {

namespace {

constexpr std::uint32_t unused = std::numeric_limits<std::uint32_t>::max();

/// Strips and fans as lists. Odd triangles of a strip are reversed, so that all have the same
/// orientation.
std::vector<glm::uvec3> assembled(const std::vector<std::uint32_t>& corners, int mode) {
  std::vector<glm::uvec3> triangles;
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    triangles.reserve(corners.size() / 3);
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
      triangles.emplace_back(corners[i], corners[i + 1], corners[i + 2]);
    return triangles;
  }
  triangles.reserve(corners.size());
  for (std::size_t i = 0; i + 2 < corners.size(); ++i) {
    if (mode == TINYGLTF_MODE_TRIANGLE_FAN)
      triangles.emplace_back(corners[0], corners[i + 1], corners[i + 2]);
    else
      triangles.emplace_back(corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]);
  }
  return triangles;
}

}  // namespace

std::vector<glm::uvec3> GltfSoupBuilder::triangles_of(const tinygltf::Primitive& primitive,
                                                      const std::string& where,
                                                      std::size_t vertices) {
  PassingMemory passing(document_.budget());
  std::vector<std::uint32_t> corners;
  if (primitive.indices >= 0) {
    corners = read_index_accessor(document_, primitive.indices, vertices);
  } else {
    document_.take_memory(vertices, sizeof corners[0], where);
    corners.resize(vertices);
    for (std::size_t i = 0; i < vertices; ++i) corners[i] = std::uint32_t(i);
  }
  if (primitive.mode == TINYGLTF_MODE_TRIANGLES && corners.size() % 3 != 0)
    tally_.remarks.push_back(
        {&remarks::corners_dropped, {{"corners", corners.size()}, {"primitive", where}}});
  // A strip or a fan has two triangles fewer than corners.
  const bool list = primitive.mode == TINYGLTF_MODE_TRIANGLES;
  document_.take_memory(list ? corners.size() / 3 : corners.size(), sizeof(glm::uvec3), where);
  return assembled(corners, primitive.mode);
}

void GltfSoupBuilder::add_primitive(const tinygltf::Primitive& primitive, const std::string& where,
                                    const glm::dmat4& world_from_mesh) {
  if (primitive.mode >= TINYGLTF_MODE_POINTS && primitive.mode <= TINYGLTF_MODE_LINE_STRIP) {
    tally_.remarks.push_back({&remarks::points_and_lines_dropped});
    return;
  }
  if (primitive.mode < TINYGLTF_MODE_TRIANGLES || primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN)
    document_.fail(where, "mode " + std::to_string(primitive.mode) + " is unknown");
  const auto position = primitive.attributes.find("POSITION");
  if (position == primitive.attributes.end()) {
    tally_.remarks.push_back({&remarks::primitives_without_positions_dropped});
    return;
  }
  if (!primitive.targets.empty()) tally_.remarks.push_back({&remarks::morph_targets_dropped});

  const std::size_t vertices = accessor_count(document_, position->second);
  if (vertices >= unused) document_.fail(where, "has more vertices than 32 bits can count");
  std::vector<glm::uvec3> triangles = triangles_of(primitive, where, vertices);

  // Only the vertices that this primitive uses, in ascending order: exporters let many primitives
  // share one large accessor.
  std::vector<std::uint32_t> used;
  // Temporary memory while this primitive is added, in bytes.
  const std::uint64_t passing =
      std::uint64_t(triangles.size()) * sizeof triangles[0] +
      2 * std::min<std::uint64_t>(vertices, 3 * std::uint64_t(triangles.size())) * sizeof used[0];
  document_.take_memory(passing, 1, where);
  if (tally_.renamed.size() < vertices) {
    document_.make_room_in(tally_.renamed, vertices - tally_.renamed.size(), where);
    tally_.renamed.resize(vertices, unused);
  }
  for (const glm::uvec3& triangle : triangles)
    for (int k = 0; k < 3; ++k)
      if (tally_.renamed[triangle[k]] == unused) {
        tally_.renamed[triangle[k]] = 0;
        used.push_back(triangle[k]);
      }
  if (!std::is_sorted(used.begin(), used.end())) std::sort(used.begin(), used.end());
  tally_.vertices += used.size();
  tally_.faces += triangles.size();
  if (tally_.vertices > document_.vertex_budget() || tally_.vertices >= unused ||
      tally_.faces > 4 * document_.vertex_budget())
    document_.fail(where, "the scene's nodes repeat its meshes to more than " +
                              std::to_string(document_.vertex_budget()) + " vertices");

  const Part part{soup_.positions.size(), used.size(), soup_.triangles.size(), triangles.size(),
                  material(primitive.material)};
  parts_.push_back(part);
  for (std::size_t i = 0; i < used.size(); ++i)
    tally_.renamed[used[i]] = std::uint32_t(part.first_vertex + i);
  add_positions(position->second, where, world_from_mesh, used);
  document_.make_room_in(soup_.triangles, triangles.size(), where);
  for (const glm::uvec3& t : triangles)
    soup_.triangles.emplace_back(tally_.renamed[t.x], tally_.renamed[t.y], tally_.renamed[t.z]);
  for (const std::uint32_t v : used) tally_.renamed[v] = unused;

  const auto attribute = [&](const char* name) -> std::optional<int> {
    const auto found = primitive.attributes.find(name);
    if (found == primitive.attributes.end()) return std::nullopt;
    if (accessor_count(document_, found->second) != vertices)
      document_.fail(where + ".attributes." + name, "does not have as many elements as POSITION");
    return found->second;
  };
  if (const auto color = attribute("COLOR_0")) add_colors(*color, where, used);
  if (const auto normal = attribute("NORMAL")) add_normals(*normal, where, world_from_mesh, used);
  add_uv(primitive, materials_[part.material], where, used);
  document_.budget().give_back(passing);
}

void GltfSoupBuilder::add_positions(int accessor, const std::string& where,
                                    const glm::dmat4& world_from_mesh,
                                    const std::vector<std::uint32_t>& used) {
  document_.make_room_in(soup_.positions, used.size(), where);
  PassingMemory passing(document_.budget());
  const FloatElements positions = read_float_elements(document_, accessor, {3}, used);
  for (std::size_t i = 0; i < used.size(); ++i) {
    const float* p = &positions.values[3 * i];
    soup_.positions.emplace_back(world_from_mesh * glm::dvec4(p[0], p[1], p[2], 1.0));
  }
}

void GltfSoupBuilder::add_normals(int accessor, const std::string& where,
                                  const glm::dmat4& world_from_mesh,
                                  const std::vector<std::uint32_t>& used) {
  const std::size_t first = soup_.positions.size() - used.size();
  document_.make_room_in(soup_.normals, first + used.size() - soup_.normals.size(), where);
  PassingMemory passing(document_.budget());
  const FloatElements normals = read_float_elements(document_, accessor, {3}, used);
  const glm::dmat3 matrix = normal_matrix(glm::dmat3(world_from_mesh));
  soup_.normals.resize(first, glm::vec3(0.0f));
  for (std::size_t i = 0; i < used.size(); ++i) {
    const float* n = &normals.values[3 * i];
    soup_.normals.push_back(unit_or_zero(matrix * glm::dvec3(n[0], n[1], n[2])));
  }
}

void GltfSoupBuilder::add_colors(int accessor, const std::string& where,
                                 const std::vector<std::uint32_t>& used) {
  const std::size_t first = soup_.positions.size() - used.size();
  document_.make_room_in(vertex_colors_, first + used.size() - vertex_colors_.size(), where);
  PassingMemory passing(document_.budget());
  const FloatElements colors = read_float_elements(document_, accessor, {3, 4}, used);
  if (document_.model().accessors[std::size_t(accessor)].componentType !=
          TINYGLTF_COMPONENT_TYPE_FLOAT &&
      !document_.model().accessors[std::size_t(accessor)].normalized)
    document_.fail(where + ".attributes.COLOR_0", "holds integers that are not normalised");
  vertex_colors_.resize(first, glm::vec4(1.0f));
  for (std::size_t i = 0; i < used.size(); ++i) {
    glm::vec4 rgba(1.0f);
    // glTF clamps each component to [0, 1] before multiplication (2.0, section 3.7.2.1). The order
    // of the comparisons turns NaN into 0.
    for (int c = 0; c < colors.components; ++c)
      rgba[c] = std::min(
          std::max(0.0f, colors.values[i * std::size_t(colors.components) + std::size_t(c)]), 1.0f);
    vertex_colors_.push_back(rgba);
  }
}

void GltfSoupBuilder::add_uv(const tinygltf::Primitive& primitive, const GltfMaterial& material,
                             const std::string& where, const std::vector<std::uint32_t>& used) {
  if (material.image < 0 || used.empty()) return;
  const std::string name = "TEXCOORD_" + std::to_string(material.texture_coordinate);
  const auto attribute = primitive.attributes.find(name);
  if (attribute == primitive.attributes.end())
    document_.fail(where, "its material needs " + name + ", which is missing");
  if (used.back() >= accessor_count(document_, attribute->second))
    document_.fail(where + ".attributes." + name, "has fewer elements than POSITION");
  const std::size_t first = soup_.positions.size() - used.size();
  document_.make_room_in(uv_, first + used.size() - uv_.size(), where);
  PassingMemory passing(document_.budget());
  const FloatElements uv = read_float_elements(document_, attribute->second, {2}, used);
  uv_.resize(first, glm::vec2(0.0f));
  for (std::size_t i = 0; i < used.size(); ++i)
    uv_.emplace_back(material.uv_transform *
                     glm::dvec3(uv.values[2 * i], uv.values[2 * i + 1], 1.0));
}

std::size_t GltfSoupBuilder::material(int index) {
  const auto [entry, fresh] = material_index_.try_emplace(index, materials_.size());
  if (fresh) materials_.push_back(read_gltf_material(document_, index, tally_.remarks));
  return entry->second;
}

/// glTF multiplies linear colours. Display-referred colours with a factor of 1 are kept bit for
/// bit.
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
  document_.take_memory(soup_.positions.size(), sizeof colors.rgba[0], "");
  colors.rgba.reserve(soup_.positions.size());
  for (const Part& part : parts_) {
    const GltfMaterial& material = materials_[part.material];
    const glm::vec4 constant = glm::vec4(glm::vec3(srgb_from_linear(glm::dvec3(material.factor))),
                                         float(material.factor.w));
    for (std::size_t v = part.first_vertex; v < part.first_vertex + part.vertices; ++v) {
      glm::vec4 rgba =
          vertex_colors_.empty() ? constant : display_color(vertex_colors_[v], material.factor);
      // Shifted, not scaled: an alpha equal to the cutoff becomes alpha_threshold exactly, and
      // interpolated alpha crosses both at the same place.
      rgba.w = material.masked ? rgba.w - material.cutoff + alpha_threshold : 1.0f;
      colors.rgba.push_back(rgba);
    }
  }
  return colors;
}

UvTextures GltfSoupBuilder::as_uv_textures() {
  UvTextures textures;
  document_.make_room_in(uv_, soup_.positions.size() - uv_.size(), "");
  document_.take_memory(soup_.triangles.size(), sizeof(std::uint32_t), "");
  document_.take_memory(vertex_colors_.size(), sizeof vertex_colors_[0], "");
  textures.vertex_rgba.reserve(vertex_colors_.size());
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
  if (multiplied) tally_.remarks.push_back({&remarks::colors_multiplied});
  return textures;
}

TriangleSoup GltfSoupBuilder::finish() {
  if (has_vertex_colors()) {
    document_.make_room_in(vertex_colors_, soup_.positions.size() - vertex_colors_.size(), "");
    vertex_colors_.resize(soup_.positions.size(), glm::vec4(1.0f));
  }
  if (!soup_.normals.empty()) {
    document_.make_room_in(soup_.normals, soup_.positions.size() - soup_.normals.size(), "");
    soup_.normals.resize(soup_.positions.size(), glm::vec3(0.0f));
  }
  const bool textured = std::any_of(materials_.begin(), materials_.end(),
                                    [](const GltfMaterial& m) { return m.image >= 0; });
  if (textured)
    soup_.appearance = as_uv_textures();
  else
    soup_.appearance = as_vertex_colors();
  return std::move(soup_);
}

}  // namespace tureen
