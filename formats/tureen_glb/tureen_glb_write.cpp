// Writes TUREEN_triangle_soup. The binary chunk is a list of pieces, most of them arrays of the
// scene. The JSON describes it, and both are streamed to the file.
#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <glm/geometric.hpp>
#include <limits>

#include "base/output.hpp"
#include "formats/glb/glb_material.hpp"
#include "formats/tureen_glb/tureen_glb.hpp"
#include "formats/tureen_glb/tureen_glb_geometry.hpp"
#include "formats/tureen_glb/tureen_glb_layout.hpp"
#include "formats/tureen_glb/tureen_glb_quality.hpp"
#include "formats/tureen_glb/tureen_glb_splats.hpp"
#include "formats/tureen_glb/tureen_glb_writing.hpp"
#include "image/png.hpp"
#include "image/srgb.hpp"
#include "scene/edit/baked_transform.hpp"
#include "scene/edit/mean_color.hpp"
#include "scene/edit/opaque_windows.hpp"
#include "scene/lattice.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen {

using namespace glb_writing;

namespace {

/// The colours as bytes if every component is exactly byte / 255; otherwise empty.
std::vector<glm::u8vec4> exact_bytes(const std::vector<glm::vec4>& colors) {
  std::vector<glm::u8vec4> bytes(colors.size());
  for (std::size_t i = 0; i < colors.size(); ++i)
    for (int c = 0; c < 4; ++c) {
      const float value = colors[i][c];
      if (!(value >= 0.0f && value <= 1.0f) || std::signbit(value)) return {};
      bytes[i][c] = static_cast<std::uint8_t>(std::lround(value * 255.0f));
      if (float(bytes[i][c]) / 255.0f != value) return {};
    }
  return bytes;
}

void add_colors(BinaryPlan& plan, json& holder, const std::vector<glm::vec4>& colors) {
  if (const auto bytes = exact_bytes(colors); !bytes.empty())
    plan.owned_accessor(holder, "rgba", bytes, vec4_unorm8);
  else
    plan.accessor(holder, "rgba", bytes_of(colors), vec4_float);
}

template <class Numbers>
void require_finite(const Numbers& numbers, const std::string& what) {
  for (const auto number : numbers)
    if (!std::isfinite(number))
      throw UsageError("a GLB cannot hold " + what + ": it is not finite");
}

template <int N, class Real>
json array_of(const glm::vec<N, Real>& v, const std::string& what) {
  std::vector<Real> numbers;
  for (int i = 0; i < N; ++i) numbers.push_back(v[i]);
  require_finite(numbers, what);
  return numbers;
}

/// Adds the arrays of an appearance; the small ones (colours, MLP) precede the texels.
struct AddAppearance {
  BinaryPlan& plan;

  json operator()(const FaceColors& colors) const {
    json result = {{"type", "face_colors"}};
    add_colors(plan, result, colors.rgba);
    return result;
  }

  json operator()(const VertexColors& colors) const {
    json result = {{"type", "vertex_colors"}};
    add_colors(plan, result, colors.rgba);
    return result;
  }

  json operator()(const Harmonics& sh) const {
    json result = {{"type", "harmonics"},
                   {"domain", layout::domains[int(sh.domain)]},
                   {"degree", sh.degree},
                   {"view", view_conventions[int(sh.view)]}};
    plan.accessor(result, "coefficients", bytes_of(sh.coefficients), vec3_float);
    return result;
  }

  json operator()(const LatticeTexture& texture) const {
    json result = {{"type", "lattice_texture"}, {"texel_count", texture.texel_count()}};
    add_patches(result, texture.patches);
    if (texture.mlp) result["color_mlp"] = mlp_json(plan, *texture.mlp);
    if (const auto* floats = std::get_if<std::vector<float>>(&texture.texels))
      plan.accessor(result, "texels", bytes_of(*floats), scalar_float);
    else
      add_strips(result, std::get<std::vector<std::uint8_t>>(texture.texels));
    return result;
  }

  json operator()(const UvTextures& textures) const {
    json result = {{"type", "uv_textures"}};
    plan.accessor(result, "uv", bytes_of(textures.uv), vec2_float);
    plan.accessor(result, "material_of_face", bytes_of(textures.material_of_face), scalar_u32);
    if (!textures.vertex_rgba.empty()) add_colors(plan, result, textures.vertex_rgba);
    if (textures.mlp) result["color_mlp"] = mlp_json(plan, *textures.mlp);
    json materials = json::array();
    for (const UvMaterial& material : textures.materials) {
      require_finite(std::array{material.mask_threshold}, "a material's mask threshold");
      materials.push_back({{"images", material.images},
                           {"wrap_u", layout::wraps[int(material.wrap_u)]},
                           {"wrap_v", layout::wraps[int(material.wrap_v)]},
                           {"filter", layout::filters[int(material.filter)]},
                           {"factor", array_of(material.factor, "a material's factor")},
                           {"mask_channel", material.mask_channel},
                           {"mask_threshold", material.mask_threshold}});
    }
    result["materials"] = std::move(materials);
    json images = json::array();
    for (const Image8& image : textures.images) {
      if (image.width > max_image_side || image.height > max_image_side ||
          image.pixels.size() > max_image_pixels)
        throw UsageError("a GLB of ours cannot hold an image of " + std::to_string(image.width) +
                         " x " + std::to_string(image.height) + " pixels");
      images.push_back(plan.image(image));
    }
    result["images"] = std::move(images);
    return result;
  }

  /// A single level if all patches have the same one and are contiguous, as trainers write them.
  void add_patches(json& result, const std::vector<LatticePatch>& patches) const {
    const std::uint32_t level = patches.empty() ? 0 : patches.front().level;
    const std::uint64_t each = lattice::texel_count(int(level));
    bool uniform = true;
    for (std::size_t t = 0; t < patches.size() && uniform; ++t)
      uniform = patches[t].level == level && patches[t].first_texel == t * each;
    if (uniform) {
      result["level"] = level;
      return;
    }
    std::vector<std::uint32_t> first_texels;
    std::vector<std::uint8_t> levels;
    for (const LatticePatch& patch : patches) {
      first_texels.push_back(patch.first_texel);
      levels.push_back(static_cast<std::uint8_t>(patch.level));
    }
    plan.owned_accessor(result, "first_texels", first_texels, scalar_u32);
    plan.owned_accessor(result, "levels", levels, scalar_u8);
  }

  void add_strips(json& result, const std::vector<std::uint8_t>& texels) const {
    json strips = json::array();
    const std::size_t total = texels.size() / LatticeTexture::channels;
    for (std::size_t first = 0; first < total; first += layout::strip_texels) {
      const std::size_t count = std::min<std::size_t>(layout::strip_texels, total - first);
      const int width = int(std::min<std::size_t>(layout::strip_width, count));
      const int height = int((count + width - 1) / width);
      // Pixels after the last texel stay zero.
      Image8 low(width, height), high(width, height);
      for (std::size_t i = 0; i < count; ++i) {
        const std::uint8_t* texel = &texels[(first + i) * LatticeTexture::channels];
        low.pixels[i] = {texel[0], texel[1], texel[2], texel[3]};
        high.pixels[i] = {texel[4], texel[5], texel[6], texel[7]};
      }
      const std::size_t low_index = plan.image(low);
      const std::size_t high_index = plan.image(high);
      strips.push_back({{"first", first}, {"count", count}, {"images", {low_index, high_index}}});
    }
    result["strips"] = std::move(strips);
  }
};

bool is_unshared(const TriangleSoup& soup) {
  if (soup.positions.size() != 3 * soup.triangles.size()) return false;
  for (std::size_t t = 0; t < soup.triangles.size(); ++t)
    if (soup.triangles[t] != glm::uvec3(3 * t, 3 * t + 1, 3 * t + 2)) return false;
  return true;
}

/// The mesh for other glTF viewers. If faces share vertices but not a colour, the mesh is an
/// unshared copy, and the soup's own vertices and triangles follow it. Without `with_colors`, the
/// material alone gives the colour.
json add_mesh(BinaryPlan& plan, json& extension, const TriangleSoup& soup, bool with_colors) {
  json attributes, primitive = {{"material", 0}, {"mode", 4}};
  const auto* vertex_colors = std::get_if<VertexColors>(&soup.appearance);
  const bool unshared = is_unshared(soup);
  const std::size_t faces = soup.triangles.size();

  std::vector<glm::vec3> corners;  // of the unshared copy, if any

  if (unshared || vertex_colors) {
    plan.accessor(attributes, "POSITION", bytes_of(soup.positions), vec3_float);
    if (attributes.contains("POSITION")) extension["positions"] = attributes["POSITION"];
    if (!unshared) {
      plan.accessor(primitive, "indices", bytes_of(soup.triangles), scalar_u32);
      if (primitive.contains("indices")) extension["triangles"] = primitive["indices"];
    }
  } else {
    corners.reserve(3 * faces);
    for (const glm::uvec3& triangle : soup.triangles)
      for (int k = 0; k < 3; ++k) corners.push_back(soup.positions[triangle[k]]);
    plan.owned_accessor(attributes, "POSITION", corners, vec3_float);
    plan.accessor(extension, "positions", bytes_of(soup.positions), vec3_float);
    plan.accessor(extension, "triangles", bytes_of(soup.triangles), scalar_u32);
  }
  if (faces == 0 || !attributes.contains("POSITION")) return nullptr;
  add_range(plan.accessors[attributes["POSITION"].get<std::size_t>()],
            corners.empty() ? soup.positions : corners);

  std::vector<glm::u16vec4> colors;
  if (!with_colors) {
    // no COLOR_0
  } else if (vertex_colors) {
    colors.reserve(vertex_colors->rgba.size());
    for (const glm::vec4& rgba : vertex_colors->rgba)
      colors.push_back(linear_unorm16(glm::vec3(rgba)));
  } else {
    colors.reserve(3 * faces);
    for (const glm::vec3& mean : mean_colors(soup))
      colors.insert(colors.end(), 3, linear_unorm16(mean));
  }
  plan.owned_accessor(attributes, "COLOR_0", colors, vec4_unorm16);
  primitive["attributes"] = std::move(attributes);
  return primitive;
}

/// The rotation (x, y, z, w) from the scene's up axis to glTF's y axis.
json upright(const glm::vec3& up) {
  const glm::dvec3 from = glm::normalize(glm::dvec3(up));
  // A rotation by 180 degrees has no unique axis; any horizontal one will do. 1e-12 is far above
  // the rounding error of the sum and far below any visible angle.
  if (!(1.0 + from.y > 1e-12)) return {1.0, 0.0, 0.0, 0.0};
  const glm::dvec3 axis = glm::cross(from, glm::dvec3(0, 1, 0));
  const glm::dvec4 q = glm::normalize(glm::dvec4(axis, 1.0 + from.y));
  return {q.x, q.y, q.z, q.w};
}

/// Column by column.
std::vector<double> numbers_of(const glm::dmat4& matrix) {
  std::vector<double> numbers;
  for (int i = 0; i < 16; ++i) numbers.push_back(matrix[i / 4][i % 4]);
  return numbers;
}

/// The text with invalid UTF-8 replaced, because JSON cannot store it. A replacement is a loss.
std::string utf8(const std::string& text, std::vector<std::string>& losses) {
  try {
    static_cast<void>(json(text).dump());
    return text;
  } catch (const json::exception&) {
    losses.push_back("a text is not UTF-8; its invalid bytes are replaced");
    return json::parse(json(text).dump(-1, ' ', false, json::error_handler_t::replace))
        .get<std::string>();
  }
}

/// Adds the soup's normals, and to a mesh that is lit NORMAL. glTF allows no normal of length 0.
void add_normals(BinaryPlan& plan, json& extension, json& primitive, const TriangleSoup& soup) {
  plan.accessor(extension, "normals", bytes_of(soup.normals), vec3_float);
  const auto& normals = soup.normals;
  if (primitive.is_null() || !extension.contains("material") || normals.empty() ||
      std::find(normals.begin(), normals.end(), glm::vec3(0.0f)) != normals.end())
    return;
  json& attributes = primitive["attributes"];
  if (attributes["POSITION"] == extension["positions"]) {
    attributes["NORMAL"] = extension["normals"];
    return;
  }
  std::vector<glm::vec3> corners;
  for (const glm::uvec3& triangle : soup.triangles)
    for (int k = 0; k < 3; ++k) corners.push_back(normals[triangle[k]]);
  plan.owned_accessor(attributes, "NORMAL", corners, vec3_float);
}

json windows_json(BinaryPlan& plan, const Splats& splats) {
  const auto& windows = std::get<TriangleWindows>(splats.kernel);
  json result = {{"type", "soft_triangles"}, {"degree", splats.color.degree}};
  if (splats.color.per_corner) result["domain"] = layout::domains[int(Harmonics::Domain::vertex)];
  plan.accessor(result, "coefficients", bytes_of(splats.color.coefficients), vec3_float);
  plan.accessor(result, "sigma", bytes_of(windows.sigma), scalar_float);
  plan.accessor(result, "opacity", bytes_of(windows.opacity), scalar_float);
  if (needs_splat_version(splats)) result["profile"] = profile_json(splats.profile);
  return result;
}

}  // namespace

namespace glb_writing {

void add_range(json& accessor, const std::vector<glm::vec3>& positions) {
  glm::vec3 low(std::numeric_limits<float>::infinity()), high = -low;
  for (const glm::vec3& p : positions)
    for (int k = 0; k < 3; ++k)
      if (std::isfinite(p[k])) {
        low[k] = std::min(low[k], p[k]);
        high[k] = std::max(high[k], p[k]);
      }
  if (!(low.x <= high.x && low.y <= high.y && low.z <= high.z)) return;
  accessor["min"] = {low.x, low.y, low.z};
  accessor["max"] = {high.x, high.y, high.z};
}

glm::u16vec4 linear_unorm16(const glm::vec3& display, double alpha) {
  const glm::dvec3 linear = linear_from_srgb(glm::dvec3(display));
  return glm::u16vec4(glm::dvec4(linear, alpha) * 65535.0 + 0.5);
}

json mlp_json(BinaryPlan& plan, const ColorMlp& mlp) {
  json layers = json::array();
  for (const DenseLayer& layer : mlp.layers) {
    json entry = {{"inputs", layer.inputs}, {"outputs", layer.outputs}};
    plan.accessor(entry, "weights", bytes_of(layer.weights), scalar_float);
    plan.accessor(entry, "biases", bytes_of(layer.biases), scalar_float);
    layers.push_back(std::move(entry));
  }
  json result = {{"layers", std::move(layers)},
                 {"encoding", direction_encodings[int(mlp.encoding)]},
                 {"view", view_conventions[int(mlp.view)]}};
  if (mlp.blend_channel) result["blend_channel"] = *mlp.blend_channel;
  return result;
}

std::size_t MaterialList::add(const Material& material) {
  require_sound(material);
  if (std::find(materials_.begin(), materials_.end(), material) == materials_.end())
    materials_.push_back(material);
  const auto found = std::find(materials_.begin(), materials_.end(), material);
  return std::size_t(found - materials_.begin()) + 1;
}

void MaterialList::write(json& document) const {
  if (materials_.empty() && !document.contains("meshes")) return;
  document["materials"] =
      json::array({{{"doubleSided", true},
                    {"alphaMode", "OPAQUE"},
                    // For viewers without KHR_materials_unlit: neither metallic nor glossy.
                    {"pbrMetallicRoughness", {{"metallicFactor", 0.0}, {"roughnessFactor", 1.0}}},
                    {"extensions", {{"KHR_materials_unlit", json::object()}}}}});
  for (const Material& material : materials_)
    document["materials"].push_back(glb_material_json(material));
  json& used = document["extensionsUsed"];
  for (const json& material : document["materials"])
    if (material.contains("extensions"))
      for (const auto& [name, ignored] : material["extensions"].items())
        if (std::find(used.begin(), used.end(), name) == used.end()) used.push_back(name);
}

json camera_json(const Camera& camera, std::vector<std::string>& losses) {
  const std::vector<double> matrix = numbers_of(camera.view_from_world);
  const std::string what = "camera \"" + camera.name + "\"";
  for (const int side : {camera.width, camera.height})
    if (side < 1 || side > max_image_side)
      throw UsageError("a GLB cannot hold " + what + " of " + std::to_string(camera.width) + " x " +
                       std::to_string(camera.height) + " pixels");
  require_finite(matrix, what);
  require_finite(std::array{camera.fx, camera.fy, camera.cx, camera.cy}, what);
  return {{"name", utf8(camera.name, losses)},
          {"width", camera.width},
          {"height", camera.height},
          {"fx", camera.fx},
          {"fy", camera.fy},
          {"cx", camera.cx},
          {"cy", camera.cy},
          {"view_from_world", matrix}};
}

json info_json(const Scene& scene, std::vector<std::string>& losses) {
  const SceneInfo& info = scene.info;
  if (info.up == glm::vec3(0.0f)) throw UsageError("a GLB cannot hold an up axis of length 0");
  json extension = {{"name", utf8(info.name, losses)},
                    {"source", utf8(info.source, losses)},
                    {"notes", json::array()},
                    {"up", array_of(info.up, "the up axis")},
                    {"background", array_of(info.background, "the background")},
                    {"cameras", json::array()}};
  for (const std::string& note : all_notes(info)) extension["notes"].push_back(utf8(note, losses));
  for (const Camera& camera : scene.cameras)
    extension["cameras"].push_back(camera_json(camera, losses));
  if (scene.first_view) {
    if (const auto reason = view_defect(*scene.first_view))
      throw UsageError("a GLB cannot hold the first view: it is " + *reason);
    extension["first_view"] = camera_json(*scene.first_view, losses);
  }
  if (scene.quality != Quality{}) {
    require_sound(scene.quality);
    extension["preset"] = quality_json(scene.quality);
  }
  return extension;
}

void add_origin(json& extension, const Layer& layer) {
  extension["origin"] = array_of(origin_of(layer), "the origin");
}

void write_glb(json document, const BinaryPlan& plan, const std::filesystem::path& path) {
  if (!plan.accessors.empty()) document["accessors"] = plan.accessors;
  if (!plan.images.empty()) document["images"] = plan.images;
  if (!plan.buffer_views.empty()) {
    document["bufferViews"] = plan.buffer_views;
    document["buffers"] = json::array({{{"byteLength", plan.size()}}});
  }

  std::string text = document.dump();
  text.append((4 - text.size() % 4) % 4, ' ');
  const bool has_binary = plan.size() > 0;
  const std::uint64_t length = 12 + 8 + text.size() + (has_binary ? 8 + plan.size() : 0);
  if (length > std::numeric_limits<std::uint32_t>::max())
    throw UsageError("the scene takes " + std::to_string(length) +
                     " bytes, and a GLB holds at most 4 GiB");

  Output output(path);
  output.write(std::string_view("glTF"));
  output.write_value(std::uint32_t(2));
  output.write_value(static_cast<std::uint32_t>(length));
  output.write_value(static_cast<std::uint32_t>(text.size()));
  output.write(std::string_view("JSON"));
  output.write(std::string_view(text));
  if (has_binary) {
    output.write_value(static_cast<std::uint32_t>(plan.size()));
    output.write(std::string_view("BIN\0", 4));
    plan.write(output);
  }
  output.commit();
}

}  // namespace glb_writing

namespace {

/// Whether a layer needs version 5.
bool has_splat_layers(const Scene& scene) {
  return std::any_of(scene.layers.begin(), scene.layers.end(), [](const Layer& layer) {
    const auto* splats = std::get_if<Splats>(&layer.primitives);
    return splats && needs_splat_version(*splats);
  });
}

/// The pixels of the images that store the texels of soups.
std::uint64_t image_pixels(const Scene& scene) {
  std::uint64_t pixels = 0;
  for (const Layer& layer : scene.layers) {
    const auto* soup = std::get_if<TriangleSoup>(&layer.primitives);
    if (!soup) continue;
    if (const auto* lattice = std::get_if<LatticeTexture>(&soup->appearance))
      if (std::holds_alternative<std::vector<std::uint8_t>>(lattice->texels))
        pixels += 2 * lattice->texel_count();
    if (const auto* textures = std::get_if<UvTextures>(&soup->appearance))
      for (const Image8& image : textures->images) pixels += image.pixels.size();
  }
  return pixels;
}

/// Whether versions 1 and 3 can store everything about the layer except its primitives.
bool is_plain(const Layer& layer) {
  return layer.name.empty() && layer.visible && is_translation(layer);
}

/// The document of one file: its arrays, its meshes for other glTF viewers, and its nodes.
class Document {
 public:
  void report_to(const std::function<void(double)>& progress, const Scene& scene) {
    plan_.report_to(progress, image_pixels(scene));
  }

  /// Adds the layer's geometry and appearance to `extension`, and its mesh. Returns the mesh's
  /// index, or null for a layer without faces: glTF does not allow an empty mesh.
  json add_primitives(json& extension, const Layer& layer) {
    const auto* splats = std::get_if<Splats>(&layer.primitives);
    if (splats && !std::holds_alternative<TriangleWindows>(splats->kernel)) {
      any_points_ = true;
      return add_mesh_of(add_splats(plan_, extension, *splats));
    }
    const TriangleSoup& soup = splats ? shapes_.emplace_back(checked_shapes(*splats))
                                      : std::get<TriangleSoup>(layer.primitives);
    require_sound(soup);
    extension["vertex_count"] = soup.positions.size();
    extension["face_count"] = soup.triangles.size();
    const bool has_material = layer.material && !splats;
    if (has_material) extension["material"] = materials_.add(*layer.material);
    json primitive = add_mesh(plan_, extension, soup, !has_material);
    if (has_material && !primitive.is_null()) primitive["material"] = extension["material"];
    extension["appearance"] =
        splats ? windows_json(plan_, *splats) : std::visit(AddAppearance{plan_}, soup.appearance);
    add_normals(plan_, extension, primitive, soup);
    return add_mesh_of(std::move(primitive));
  }

  /// Adds the layer as a node, and its index to `indices`.
  void add_node(json& indices, const Layer& layer, std::vector<std::string>& losses) {
    require_sound(layer);
    json node = {{"name", utf8(layer.name, losses)},
                 {"matrix", numbers_of(layer.world_from_layer)}};
    json extension = json::object();
    if (json mesh = add_primitives(extension, layer); !mesh.is_null()) node["mesh"] = mesh;
    node["extensions"][tureen_extension] = std::move(extension);
    if (!layer.visible) {
      node["extensions"][layout::visibility_extension] = {{"visible", false}};
      any_hidden_ = true;
    }
    indices.push_back(nodes.size());
    nodes.push_back(std::move(node));
  }

  /// Writes the file. `extension` is that of the root.
  void write(json extension, const std::filesystem::path& path) {
    json document = {{"asset", {{"version", "2.0"}, {"generator", "Tureen"}}},
                     {"scene", 0},
                     {"scenes", json::array({json::object()})},
                     {"extensionsUsed", json::array()},
                     {"extensions", {{tureen_extension, std::move(extension)}}}};
    if (!nodes.empty()) {
      document["scenes"][0]["nodes"] = json::array({0});
      document["nodes"] = std::move(nodes);
    }
    if (!meshes_.empty()) document["meshes"] = std::move(meshes_);
    materials_.write(document);
    if (any_points_) {
      document["extensionsUsed"].push_back(layout::splatting_extension);
      document["extensionsUsed"].push_back(layout::splats_extension);
    }
    if (any_hidden_) document["extensionsUsed"].push_back(layout::visibility_extension);
    document["extensionsUsed"].push_back(tureen_extension);
    write_glb(std::move(document), plan_, path);
  }

  json nodes = json::array();  // the first is the root of the scene

 private:
  /// Returns the index of the new mesh; null if the primitive is null.
  json add_mesh_of(json primitive) {
    if (primitive.is_null()) return nullptr;
    meshes_.push_back({{"primitives", json::array({std::move(primitive)})}});
    return meshes_.size() - 1;
  }

  static TriangleSoup checked_shapes(const Splats& splats) {
    require_sound(splats);
    return hard_shapes(std::get<TriangleWindows>(splats.kernel).corners, splats.color);
  }

  BinaryPlan plan_;
  std::deque<TriangleSoup> shapes_;  // the plan refers to them; a deque never moves its elements
  json meshes_ = json::array();
  MaterialList materials_;
  bool any_hidden_ = false;
  bool any_points_ = false;  // a layer of splats that are stored as points
};

}  // namespace

std::vector<std::string> write_tureen_glb(const Scene& scene, const std::filesystem::path& path,
                                          const std::function<void(double)>& progress) {
  if (scene.layers.size() > max_layers)
    throw UsageError("a GLB holds at most " + std::to_string(max_layers) +
                     " layers; this scene has " + std::to_string(scene.layers.size()));
  std::vector<std::string> losses;
  json extension = info_json(scene, losses);
  Document document;
  document.report_to(progress, scene);
  const bool splats = has_splat_layers(scene);
  if (scene.layers.size() <= 1 && is_plain(only_layer(scene)) && !splats) {
    extension["version"] = tureen_extension_version;
    add_origin(extension, only_layer(scene));
    const json mesh = document.add_primitives(extension, only_layer(scene));
    if (!mesh.is_null())
      document.nodes.push_back({{"mesh", mesh}, {"rotation", upright(scene.info.up)}});
  } else {
    extension["version"] = splats ? tureen_splats_version : tureen_layers_version;
    extension["layers"] = json::array();
    document.nodes.push_back({{"rotation", upright(scene.info.up)}});
    for (const Layer& layer : scene.layers) document.add_node(extension["layers"], layer, losses);
    document.nodes[0]["children"] = extension["layers"];
  }
  document.write(std::move(extension), path);
  return losses;
}

}  // namespace tureen
