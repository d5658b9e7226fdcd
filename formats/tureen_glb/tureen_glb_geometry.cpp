#include "formats/tureen_glb/tureen_glb_geometry.hpp"

#include "base/json/json_vector.hpp"
#include "formats/glb/glb_material.hpp"
#include "formats/tureen_glb/tureen_glb.hpp"
#include "formats/tureen_glb/tureen_glb_layout.hpp"
#include "image/png.hpp"

namespace tureen {

namespace {

/// Images of other sizes cannot be drawn, and a driver may fail on them without an error.
int side(const JsonView& view) {
  const std::uint64_t pixels = view.natural(max_image_side);
  if (pixels == 0) view.fail("an image without pixels");
  return int(pixels);
}

/// Column by column.
glm::dmat4 matrix_of(const JsonView& view) {
  if (view.size() != 16) view.fail("expected 16 numbers");
  glm::dmat4 matrix;
  for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = view.at(std::size_t(i)).number();
  return matrix;
}

Camera camera(const JsonView& view) {
  Camera result;
  result.name = view["name"].text();
  result.width = side(view["width"]);
  result.height = side(view["height"]);
  result.fx = view["fx"].number();
  result.fy = view["fy"].number();
  result.cx = view["cx"].number();
  result.cy = view["cy"].number();
  result.view_from_world = matrix_of(view["view_from_world"]);
  return result;
}

bool is_visible(const JsonView& node) {
  const auto extension = node["extensions"].find(glb_layout::visibility_extension);
  const auto visible = extension ? extension->find("visible") : std::nullopt;
  return !visible || visible->boolean();
}

}  // namespace

JsonView tureen_extension_of(const GlbArrays& arrays) {
  JsonView extension = arrays.root()["extensions"][tureen_extension];
  const std::uint64_t version = extension["version"].natural();
  if (version != std::uint64_t(tureen_extension_version) &&
      version != std::uint64_t(tureen_compressed_version) &&
      version != std::uint64_t(tureen_layers_version) &&
      version != std::uint64_t(tureen_splats_version))
    extension["version"].fail(
        "this file has version " + std::to_string(version) + " of " + tureen_extension +
        "; only versions " + std::to_string(tureen_extension_version) + ", " +
        std::to_string(tureen_compressed_version) + ", " + std::to_string(tureen_layers_version) +
        " and " + std::to_string(tureen_splats_version) + " are supported");
  return extension;
}

bool has_layers(const JsonView& extension) {
  return extension["version"].natural() >= std::uint64_t(tureen_layers_version);
}

void read_info(const JsonView& extension, Scene& scene) {
  SceneInfo& info = scene.info;
  info.name = extension["name"].text();
  info.source = extension["source"].text();
  const JsonView notes = extension["notes"];
  for (std::size_t i = 0; i < notes.size(); ++i) info.notes.push_back(notes.at(i).text());
  info.up = json_vector<3, float>(extension["up"]);
  if (info.up == glm::vec3(0.0f)) extension["up"].fail("has no direction");
  info.background = json_vector<3, float>(extension["background"]);
  const JsonView cameras = extension["cameras"];
  for (std::size_t i = 0; i < cameras.size(); ++i) scene.cameras.push_back(camera(cameras.at(i)));
}

Layer read_layer_at_origin(const JsonView& extension) {
  return {.world_from_layer = at_origin(json_vector<3, double>(extension["origin"]))};
}

Layer read_layer_of_node(const JsonView& node) {
  Layer layer;
  if (const auto name = node.find("name")) layer.name = name->text();
  const JsonView matrix = node["matrix"];
  layer.world_from_layer = matrix_of(matrix);
  if (const auto reason = defect(layer)) matrix.fail(*reason);
  layer.visible = is_visible(node);
  return layer;
}

std::optional<Material> read_layer_material(const GlbArrays& arrays, const JsonView& extension) {
  const auto reference = extension.find("material");
  if (!reference) return std::nullopt;
  const JsonView view = arrays.root()["materials"].at(GlbArrays::index(*reference));
  const Material material = read_glb_material(view);
  if (const auto reason = defect(material)) view.fail(*reason);
  return material;
}

GeometryLayout geometry_layout(const GlbArrays& arrays, const JsonView& extension) {
  GeometryLayout layout;
  layout.vertices = extension["vertex_count"].natural(GlbArrays::max_count);
  layout.faces = extension["face_count"].natural(GlbArrays::max_count);
  layout.positions =
      arrays.location(extension, "positions", layout.vertices, glb_formats::vec3_float);
  if (extension.find("triangles") || layout.faces == 0)
    layout.triangles =
        arrays.location(extension, "triangles", 3 * layout.faces, glb_formats::scalar_u32);
  else if (layout.vertices != 3 * layout.faces)
    extension.fail(std::to_string(layout.faces) + " faces without \"triangles\" need " +
                   std::to_string(3 * layout.faces) + " vertices, not " +
                   std::to_string(layout.vertices));
  return layout;
}

void read_geometry(GlbArrays& arrays, const GeometryLayout& layout, TriangleSoup& soup) {
  soup.positions = arrays.read_at<glm::vec3>(layout.positions, "positions");
  soup.triangles = arrays.read_at<glm::uvec3>(layout.triangles, "triangles");
  if (!soup.triangles.empty()) return;
  arrays.take_memory(layout.faces, sizeof(glm::uvec3), "triangles");
  soup.triangles = unshared_triangles(static_cast<std::size_t>(layout.faces));
}

}  // namespace tureen
