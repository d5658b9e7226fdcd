// An OBJ as a scene: its triangles with the colours and textures of its material libraries.
#include <algorithm>
#include <glm/common.hpp>
#include <map>
#include <utility>

#include "formats/common/uri.hpp"
#include "formats/mesh/mesh_remarks.hpp"
#include "formats/mesh/mtl.hpp"
#include "formats/mesh/obj.hpp"
#include "formats/mesh/plain_mesh.hpp"
#include "image/png.hpp"

namespace tureen {

namespace {

namespace fs = std::filesystem;

/// Rows of a list in a remark; a hostile file could have millions.
constexpr std::size_t max_listed = 8;
constexpr std::uint32_t no_image = no_face;

class ObjScene {
 public:
  ObjScene(const fs::path& path, const ReadOptions& options)
      : folder_(path.parent_path()), input_(Input::open(path)), options_(options) {}

  Scene read() {
    mesh_ = read_obj(input_, ObjRules{});
    if (options_.progress) options_.progress(0.5);
    read_libraries();
    for (const std::string& name : mesh_.materials) add_material(name);
    if (textures_.images.empty()) {
      Scene scene = with_colors();
      finish(scene);
      return scene;
    }
    Scene scene;
    scene.layers.push_back({.primitives = with_textures()});
    finish(scene);
    return scene;
  }

 private:
  /// Calls act(); an error other than one about memory costs only `kind`.
  template <class Act>
  void or_remark(const RemarkKind& kind, const char* field, const std::string& name, Act&& act) {
    std::string reason;
    try {
      return act();
    } catch (const InputError& error) {
      if (is_about_memory(error)) throw;
      reason = error.without_hint();
    } catch (const UriError& error) {
      reason = error.reason;
    }
    if (std::count_if(remarks_.begin(), remarks_.end(),
                      [&](const Remark& r) { return r.kind == &kind; }) < int(max_listed))
      remarks_.push_back({&kind, {{field, name}, {"reason", reason}}});
  }

  Input open(const std::string& name) {
    return Input::open(resolve_name_in_folder(folder_, name), input_.budget());
  }

  void read_libraries() {
    for (const std::string& name : mesh_.libraries)
      or_remark(remarks::material_library_missing, "library", name, [&] {
        Input library = open(name);
        for (auto& [key, material] : read_mtl(library)) library_[key] = std::move(material);
      });
  }

  /// Appends the material of mesh_.materials[textures_.materials.size()].
  void add_material(const std::string& name) {
    UvMaterial made;
    made.factor = MeshBuilder::no_color;
    const auto found = library_.find(name);
    const bool is_known = found != library_.end();
    if (!is_known && !name.empty() && missing_.size() < max_listed) missing_.push_back(name);
    if (is_known) {
      const MtlMaterial& material = found->second;
      if (material.color) made.factor = glm::vec4(glm::clamp(*material.color, 0.0f, 1.0f), 1);
      has_colors_ = has_colors_ || material.color;
      made.factor.a = glm::clamp(material.opacity, 0.0f, 1.0f);
      is_cut_out_ = is_cut_out_ || made.factor.a < 1;
      if (!material.image.empty()) add_texture(name, material, made);
    }
    input_.make_room_in(textures_.materials, 1, "the materials");
    textures_.materials.push_back(std::move(made));
  }

  void add_texture(const std::string& name, const MtlMaterial& material, UvMaterial& made) {
    or_remark(remarks::texture_missing, "material", name, [&] {
      const auto [known, is_new] = images_.try_emplace(material.image, no_image);
      if (is_new) {
        Input file = open(material.image);
        textures_.images.push_back(read_image(file));
        known->second = std::uint32_t(textures_.images.size() - 1);
      }
      if (known->second == no_image) return;  // reported already
      made.images = {known->second};
      if (material.clamps) made.wrap_u = made.wrap_v = UvMaterial::Wrap::clamp;
      // Kd multiplies its texture. Exporters that write a Kd of 0 beside one mean none.
      if (!material.color || *material.color == glm::vec3(0.0f))
        made.factor = glm::vec4(1, 1, 1, made.factor.a);
      const bool has_mask = !material.mask.empty() && material.mask == material.image;
      if (has_mask || made.factor.a < 1) made.mask_threshold = alpha_threshold;
      is_cut_out_ = is_cut_out_ || has_mask;
      if (material.is_placed && remarks_.size() < max_listed)
        remarks_.push_back({&remarks::texture_placement_dropped, {{"material", name}}});
    });
  }

  Scene with_colors() {
    MeshBuilder builder(input_);
    builder.positions = std::move(mesh_.positions);
    const bool by_vertex = !mesh_.rgb.empty();
    if (by_vertex) {
      builder.reserve_colors_of_vertices(mesh_.rgb.size());
      for (const glm::vec3& rgb : mesh_.rgb) builder.vertex_rgba.emplace_back(rgb, 1.0f);
    }
    builder.reserve_faces(mesh_.triangles.size());
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      builder.begin_face();
      for (int k = 0; k < 3; ++k) builder.add_corner(mesh_.triangles[t][k]);
      if (has_colors_ && !by_vertex)
        builder.end_face(textures_.materials[mesh_.material_of_face[t]].factor);
      else
        builder.end_face();
    }
    return builder.finish({}, "OBJ");
  }

  TriangleSoup with_textures() {
    for (glm::vec2& uv : mesh_.uv)
      uv.y = static_cast<float>(1.0 - double(uv.y));  // v = 0 is the last row of the image
    textures_.uv = std::move(mesh_.uv);
    textures_.uv.resize(mesh_.positions.size(), glm::vec2(0));
    textures_.material_of_face = std::move(mesh_.material_of_face);
    input_.take_memory(mesh_.rgb.size(), sizeof(glm::vec4), "the colours of the vertices");
    for (const glm::vec3& rgb : mesh_.rgb)
      textures_.vertex_rgba.emplace_back(glm::clamp(rgb, 0.0f, 1.0f), 1.0f);
    return {.positions = std::move(mesh_.positions),
            .triangles = std::move(mesh_.triangles),
            .appearance = std::move(textures_)};
  }

  void finish(Scene& scene) {
    scene.info.name = fs::path(input_.name()).stem().string();
    scene.info.source = "OBJ";
    choose_up(scene.info, obj_up);
    scene.info.up_is_assumed = true;
    std::vector<Remark>& all = scene.info.remarks;
    all.push_back({&remarks::up_unknown_to_obj});
    if (mesh_.polygons > 0)
      all.push_back({&remarks::polygons_split, {{"polygons", mesh_.polygons}}});
    if (mesh_.small_faces > 0)
      all.push_back({&remarks::small_faces_dropped, {{"faces", mesh_.small_faces}}});
    if (mesh_.points_and_lines > 0)
      all.push_back({&remarks::points_and_lines_skipped, {{"elements", mesh_.points_and_lines}}});
    if (!missing_.empty()) all.push_back({&remarks::materials_missing, {{"materials", missing_}}});
    if (is_cut_out_) all.push_back({&remarks::transparency_cut_out});
    all.insert(all.end(), remarks_.begin(), remarks_.end());
  }

  fs::path folder_;
  Input input_;
  const ReadOptions& options_;
  ObjMesh mesh_;
  std::map<std::string, MtlMaterial> library_;
  UvTextures textures_;  // materials and images; the rest by with_textures()
  std::map<std::string, std::uint32_t> images_;
  std::vector<std::string> missing_;
  std::vector<Remark> remarks_;
  bool has_colors_ = false, is_cut_out_ = false;
};

}  // namespace

Scene read_obj(const fs::path& path, const ReadOptions& options) {
  return ObjScene(path, options).read();
}

}  // namespace tureen
