#include "formats/gltf/gltf.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <deque>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <set>
#include <string_view>

#include "formats/glb/glb_material.hpp"
#include "formats/gltf/gltf_remarks.hpp"
#include "formats/gltf/gltf_soup.hpp"
#include "formats/gltf/gltf_splats.hpp"
#include "image/png.hpp"

namespace tureen {

namespace {

bool contains_ignoring_case(const std::string& text, const char* word) {
  const std::string wanted(word);
  return std::search(text.begin(), text.end(), wanted.begin(), wanted.end(), [](char a, char b) {
           return std::tolower(static_cast<unsigned char>(a)) ==
                  std::tolower(static_cast<unsigned char>(b));
         }) != text.end();
}

/// Whether the generator is a Python tool that writes display-referred colours to COLOR_0.
bool writes_srgb_colors(const std::string& generator) {
  for (const char* tool : {"trimesh", "open3d", "pymeshlab", "pygltflib", "pyvista"})
    if (contains_ignoring_case(generator, tool)) return true;
  return false;
}

/// Whether material[part][key] exists, for a part of the JSON that may be missing.
bool has(const std::optional<JsonView>& part, const char* key) {
  return part && part->find(key).has_value();
}

/// Mirrors and glass, materials by which rays see more than a colour:
/// materials[index] if it is a mirror or glass (scene/material.hpp), nullopt for all others and for
/// -1. The index must exist. Appends a remark if the material would be one, but has a value outside
/// its range or varies by a texture. Throws InputError for a value of the wrong type.
std::optional<Material> read_gltf_surface(const GltfDocument& document, int index,
                                          std::vector<Remark>& remarks) {
  if (index < 0) return std::nullopt;
  const JsonView json = document.root()["materials"].at(std::size_t(index));
  const auto extensions = json.find("extensions");
  if (has(extensions, "KHR_materials_unlit")) return std::nullopt;
  const Material material = read_glb_material(json);
  if (!is_mirror(material) && !is_glass(material)) return std::nullopt;

  const auto drop = [&](const std::string& reason) {
    remarks.push_back({&remarks::surface_dropped, {{"material", json.path()}, {"reason", reason}}});
    return std::nullopt;
  };
  if (const auto reason = defect(material)) return drop(*reason);
  const auto pbr = json.find("pbrMetallicRoughness");
  const auto transmission = extensions ? extensions->find(transmission_extension) : std::nullopt;
  if (has(pbr, "metallicRoughnessTexture") || has(transmission, "transmissionTexture"))
    return drop("a texture varies its metallic, roughness or transmission factor");
  if (has(pbr, "baseColorTexture"))
    remarks.push_back({&remarks::surface_texture_dropped, {{"material", json.path()}}});
  return material;
}

class Importer {
 public:
  Importer(GltfDocument& document, const ReadOptions& options, ReadSpz read_spz)
      : document_(document),
        options_(options),
        generator_(document.model().asset.generator),
        ordinary_(document, color_space(), tally_),
        splats_(document, options, read_spz) {}

  Scene scene() {
    walk();
    Scene scene;
    if (ordinary_.has_faces()) scene.layers.push_back({.primitives = soup_of(ordinary_)});
    add_surfaces(scene.layers);
    if (scene.layers.empty() && splats_.layers().empty())
      scene.layers.push_back({.primitives = soup_of(ordinary_)});
    if (auto names = document_.dropped_extensions(); !names.empty())
      tally_.remarks.push_back({&remarks::extensions_dropped, {{"extensions", std::move(names)}}});
    if (!document_.model().animations.empty())
      tally_.remarks.push_back({&remarks::animations_dropped});
    for (Layer& layer : splats_.layers()) scene.layers.push_back(std::move(layer));
    if (scene.layers.size() > max_layers)
      document_.fail("", std::to_string(scene.layers.size()) + " layers; at most " +
                             std::to_string(max_layers) + " are supported");
    for (Remark& remark : splats_.remarks()) tally_.remarks.push_back(std::move(remark));
    scene.cameras = std::move(cameras_);
    scene.info.source = generator_.empty() ? "glTF" : "glTF by " + generator_;
    if (contains_ignoring_case(generator_, "trimesh")) {
      // trimesh does not convert coordinates, and soups exported with it are z up.
      scene.info.up = {0, 0, 1};
      scene.info.up_is_assumed = true;
      tally_.remarks.push_back({&remarks::up_unknown_to_trimesh});
    }
    std::set<Remark> known;
    for (Remark& remark : tally_.remarks)
      if (known.insert(remark).second) scene.info.remarks.push_back(std::move(remark));
    if (options_.progress) options_.progress(1.0);
    return scene;
  }

 private:
  VertexColorSpace color_space() const {
    if (options_.vertex_colors != VertexColorSpace::automatic) return options_.vertex_colors;
    return writes_srgb_colors(generator_) ? VertexColorSpace::srgb : VertexColorSpace::linear;
  }

  /// The soup of a builder, without a defect.
  TriangleSoup soup_of(GltfSoupBuilder& builder) {
    TriangleSoup soup = builder.finish();
    if (const auto reason = defect(soup)) document_.fail("", *reason);
    if (builder.has_vertex_colors()) tally_.remarks.push_back({color_remark()});
    return soup;
  }

  /// Appends the mirrors and the glass. A layer that is the only one needs no name.
  void add_surfaces(std::vector<Layer>& layers) {
    std::vector<std::string> names;
    for (Surface& surface : surfaces_) {
      if (!surface.builder.has_faces()) continue;
      std::string name = surface.name;
      for (int number = 2; std::count(names.begin(), names.end(), name) > 0; ++number)
        name = surface.name + " " + std::to_string(number);
      names.push_back(name);
      layers.push_back({.name = std::move(name),
                        .primitives = soup_of(surface.builder),
                        .material = surface.material});
    }
    if (names.empty()) return;
    if (layers.size() == 1 && splats_.layers().empty()) layers.front().name.clear();
    tally_.remarks.push_back({&remarks::surfaces_split, {{"layers", std::move(names)}}});
  }

  /// The builder of primitives with materials[index]: that of their mirror or glass, or ordinary_.
  GltfSoupBuilder& builder_of(int index) {
    const auto& materials = document_.model().materials;
    if (index < 0 || std::size_t(index) >= materials.size()) return ordinary_;
    const auto material = read_gltf_surface(document_, index, tally_.remarks);
    if (!material) return ordinary_;
    for (Surface& surface : surfaces_)
      if (surface.material == *material) return surface.builder;
    if (surfaces_.size() == max_surfaces) {
      tally_.remarks.push_back(
          {&remarks::surface_dropped,
           {{"material", "materials[" + std::to_string(index) + "]"},
            {"reason", "the file has more than " + std::to_string(max_surfaces) + " of them"}}});
      return ordinary_;
    }
    const std::string& name = materials[std::size_t(index)].name;
    surfaces_.push_back({*material,
                         !name.empty()          ? name
                         : is_mirror(*material) ? "mirror"
                                                : "glass",
                         {document_, color_space(), tally_}});
    return surfaces_.back().builder;
  }

  /// Adds the primitives of meshes[index] without splats.
  void add_mesh(int index, const glm::dmat4& world_from_mesh) {
    const auto& meshes = document_.model().meshes;
    if (index < 0 || std::size_t(index) >= meshes.size())
      document_.fail("meshes", "there is no mesh " + std::to_string(index) + " of " +
                                   std::to_string(meshes.size()));
    const std::vector<tinygltf::Primitive>& primitives = meshes[std::size_t(index)].primitives;
    for (std::size_t i = 0; i < primitives.size(); ++i)
      if (!has_splats(primitives[i]))
        builder_of(primitives[i].material)
            .add_primitive(
                primitives[i],
                "meshes[" + std::to_string(index) + "].primitives[" + std::to_string(i) + "]",
                world_from_mesh);
  }

  const RemarkKind* color_remark() const {
    const bool srgb = color_space() == VertexColorSpace::srgb;
    if (options_.vertex_colors != VertexColorSpace::automatic)
      return srgb ? &remarks::vertex_colors_srgb : &remarks::vertex_colors_linear;
    return srgb ? &remarks::vertex_colors_srgb_by_generator
                : &remarks::vertex_colors_linear_by_gltf;
  }

  /// The root nodes to draw: those of the default scene, else of the first scene, else all nodes
  /// without a parent.
  std::vector<int> roots() const {
    const tinygltf::Model& model = document_.model();
    if (model.defaultScene >= 0 || !model.scenes.empty()) {
      const auto index = std::size_t(std::max(model.defaultScene, 0));
      if (index >= model.scenes.size())
        document_.fail("scene", "there is no scene " + std::to_string(index) + " of " +
                                    std::to_string(model.scenes.size()));
      return model.scenes[index].nodes;
    }
    std::vector<bool> is_child(model.nodes.size(), false);
    for (const tinygltf::Node& node : model.nodes)
      for (const int child : node.children)
        if (child >= 0 && std::size_t(child) < is_child.size()) is_child[std::size_t(child)] = true;
    std::vector<int> result;
    for (std::size_t i = 0; i < is_child.size(); ++i)
      if (!is_child[i]) result.push_back(int(i));
    return result;
  }

  /// Visits every node once. The explicit stack allows any nesting depth.
  void walk() {
    struct Visit {
      int node;
      glm::dmat4 world_from_parent;
    };
    const tinygltf::Model& model = document_.model();
    std::vector<Visit> stack;
    const std::vector<int> first = roots();
    for (auto it = first.rbegin(); it != first.rend(); ++it)
      stack.push_back({*it, glm::dmat4(1.0)});
    std::vector<bool> visited(model.nodes.size(), false);
    std::size_t done = 0;
    while (!stack.empty()) {
      const Visit visit = stack.back();
      stack.pop_back();
      if (visit.node < 0 || std::size_t(visit.node) >= model.nodes.size())
        document_.fail("nodes", "there is no node " + std::to_string(visit.node) + " of " +
                                    std::to_string(model.nodes.size()));
      const std::string where = "nodes[" + std::to_string(visit.node) + "]";
      if (visited[std::size_t(visit.node)])
        document_.fail(where, "is reached twice: it has two parents or is its own ancestor");
      visited[std::size_t(visit.node)] = true;
      const tinygltf::Node& node = model.nodes[std::size_t(visit.node)];
      const glm::dmat4 world_from_node = visit.world_from_parent * parent_from_node(node, where);
      if (node.mesh != -1) {
        if (node.skin != -1) tally_.remarks.push_back({&remarks::skins_dropped});
        add_mesh(node.mesh, world_from_node);
        splats_.add_mesh(node.mesh, {node.name, world_from_node}, where);
      }
      if (node.camera != -1) add_camera(node.camera, world_from_node, where);
      for (auto it = node.children.rbegin(); it != node.children.rend(); ++it)
        stack.push_back({*it, world_from_node});
      if (options_.progress) options_.progress(double(++done) / double(model.nodes.size() + 1));
    }
  }

  glm::dmat4 parent_from_node(const tinygltf::Node& node, const std::string& where) const {
    const auto expect = [&](const std::vector<double>& values, std::size_t count,
                            const char* what) {
      if (!values.empty() && values.size() != count)
        document_.fail(where + "." + what, "expected " + std::to_string(count) + " numbers");
      return !values.empty();
    };
    glm::dmat4 matrix(1.0);
    if (expect(node.matrix, 16, "matrix")) {
      for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = node.matrix[std::size_t(i)];
      return matrix;
    }
    if (expect(node.rotation, 4, "rotation")) {
      const std::vector<double>& q = node.rotation;
      const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
      if (!(length > 0.0)) document_.fail(where + ".rotation", "is not a rotation");
      matrix = glm::dmat4(
          glm::mat3_cast(glm::dquat(q[3] / length, q[0] / length, q[1] / length, q[2] / length)));
    }
    if (expect(node.scale, 3, "scale"))
      for (int k = 0; k < 3; ++k) matrix[k] *= node.scale[std::size_t(k)];
    if (expect(node.translation, 3, "translation"))
      matrix[3] = {node.translation[0], node.translation[1], node.translation[2], 1.0};
    return matrix;
  }

  /// glTF cameras look along -z with y up, as ours do. They store no size in pixels.
  void add_camera(int index, const glm::dmat4& world_from_node, const std::string& where) {
    constexpr int height = 720;
    const auto& all = document_.model().cameras;
    if (index < 0 || std::size_t(index) >= all.size())
      document_.fail(where,
                     "names camera " + std::to_string(index) + " of " + std::to_string(all.size()));
    const tinygltf::Camera& json = all[std::size_t(index)];
    if (json.type != "perspective") {
      tally_.remarks.push_back({&remarks::other_projections_dropped});
      return;
    }
    const double fov = json.perspective.yfov;
    // A field of view of pi would be a plane. Without an aspect ratio the viewer's applies; 16:9 is
    // assumed.
    const double aspect =
        json.perspective.aspectRatio > 0.0 ? json.perspective.aspectRatio : 16.0 / 9.0;
    glm::dmat3 axes(world_from_node);
    const double volume = std::abs(glm::determinant(axes));
    if (!(fov > 0.0 && fov < 3.14159) || !(aspect > 0.01) || !(height * aspect <= max_image_side) ||
        !(volume > 0.0) || !std::isfinite(volume)) {
      tally_.remarks.push_back({&remarks::blind_cameras_dropped});
      return;
    }
    // A scale does not change a camera's view. Orthonormal axes remove it together with shear.
    const glm::dvec3 backward = glm::normalize(axes[2]);
    const glm::dvec3 right = glm::normalize(glm::cross(axes[1], backward));
    const glm::dvec3 up = glm::cross(backward, right);
    const glm::dmat3 view_rotation = glm::transpose(glm::dmat3(right, up, backward));
    Camera camera;
    camera.name = json.name;
    camera.height = height;
    camera.width = std::max(1, int(std::lround(height * aspect)));
    camera.fx = camera.fy = 0.5 * height / std::tan(0.5 * fov);
    camera.cx = 0.5 * camera.width;
    camera.cy = 0.5 * camera.height;
    camera.view_from_world = glm::dmat4(view_rotation);
    camera.view_from_world[3] = glm::dvec4(-(view_rotation * glm::dvec3(world_from_node[3])), 1.0);
    cameras_.push_back(camera);
  }

  /// A mirror or glass. Each takes a layer; a scene has at most max_layers.
  static constexpr std::size_t max_surfaces = 64;
  struct Surface {
    Material material;
    std::string name;
    GltfSoupBuilder builder;
  };

  GltfDocument& document_;
  const ReadOptions& options_;
  std::string generator_;
  GltfTally tally_;
  GltfSoupBuilder ordinary_;      // of all other materials
  std::deque<Surface> surfaces_;  // in the order of first use
  GltfSplatBuilder splats_;
  std::vector<Camera> cameras_;
};

}  // namespace

bool is_gltf(std::span<const std::byte> head) {
  const std::string_view text(reinterpret_cast<const char*>(head.data()), head.size());
  if (text.substr(0, 4) == "glTF") return true;
  const std::size_t first =
      text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");  // and a UTF-8 byte order mark
  return first != std::string_view::npos && text[first] == '{' &&
         text.find("\"asset\"") != std::string_view::npos;
}

GlbContainer read_gltf_json(Input& input) {
  const auto bytes = input.read_rest();
  if (!is_gltf(bytes))
    input.fail_at(
        0, "neither a GLB, which begins with \"glTF\", nor glTF, which is JSON with an \"asset\"");
  GlbContainer glb;
  glb.json = parse_json(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()),
                        input.name(), 0, input.budget());
  return glb;
}

Scene read_gltf(Input& input, GlbContainer glb, const std::filesystem::path& folder,
                const ReadOptions& options, const GltfDecoders& decoders) {
  GltfDocument document(input, std::move(glb), folder, decoders);
  Scene scene = Importer(document, options, decoders.spz).scene();
  scene.info.name = std::filesystem::path(input.name()).stem().string();
  return scene;
}

}  // namespace tureen
