#include "formats/tureen_glb/tureen_glb_preview.hpp"

#include <algorithm>
#include <cstring>

#include "formats/tureen_glb/tureen_glb.hpp"
#include "formats/tureen_glb/tureen_glb_geometry.hpp"
#include "formats/tureen_glb/tureen_glb_splats.hpp"
#include "image/srgb.hpp"

namespace tureen {

namespace {

/// Display-referred values of 16-bit linear ones. Each is computed once: millions of faces have
/// thousands of values.
class SrgbOfUnorm16 {
 public:
  float operator()(std::uint16_t linear) {
    float& value = known_[linear];
    if (value < 0.0f) value = float(srgb_from_linear(linear / 65535.0));
    return value;
  }

 private:
  std::vector<float> known_ = std::vector<float>(65536, -1.0f);
};

/// Locations of the arrays of a preview.
struct PreviewLayout {
  GeometryLayout geometry;
  GlbArrays::Location colors;
  bool one_color_a_vertex = false;  // otherwise three equal ones a face

  std::uint64_t size() const {
    return std::max({geometry.positions.end(), geometry.triangles.end(), colors.end()});
  }
};

/// Returns nullopt if the file has no mesh with colours.
std::optional<PreviewLayout> preview_layout(const GlbArrays& arrays, const JsonView& extension) {
  const auto meshes = arrays.root().find("meshes");
  if (!meshes || has_layers(extension) || extension.find("slim_geometry")) return std::nullopt;
  const JsonView attributes = meshes->at(0)["primitives"].at(0)["attributes"];
  if (!attributes.find("COLOR_0")) return std::nullopt;
  PreviewLayout layout;
  layout.geometry = geometry_layout(arrays, extension);
  layout.one_color_a_vertex = extension["appearance"]["type"].text() == "vertex_colors";
  layout.colors = arrays.location(
      attributes, "COLOR_0",
      layout.one_color_a_vertex ? layout.geometry.vertices : 3 * layout.geometry.faces,
      glb_formats::vec4_unorm16);
  return layout;
}

/// Every `stride`-th colour from `bytes` on, `count` in all.
std::vector<glm::vec4> display_colors(const std::byte* bytes, std::size_t count,
                                      std::size_t stride) {
  SrgbOfUnorm16 srgb;
  std::vector<glm::vec4> result(count);
  for (std::size_t i = 0; i < count; ++i) {
    glm::u16vec4 linear;
    std::memcpy(&linear, bytes + i * stride * sizeof linear, sizeof linear);
    result[i] = {srgb(linear.x), srgb(linear.y), srgb(linear.z), 1.0f};
  }
  return result;
}

Scene read_preview(GlbArrays& arrays, const JsonView& extension, const PreviewLayout& layout,
                   std::span<const std::byte> prefix) {
  Scene scene;
  read_info(extension, scene);
  TriangleSoup soup;
  read_geometry(arrays, layout.geometry, soup);
  const std::byte* colors = prefix.data() + layout.colors.offset;
  if (layout.one_color_a_vertex)
    soup.appearance = VertexColors{display_colors(colors, soup.positions.size(), 1)};
  else
    soup.appearance = FaceColors{display_colors(colors, soup.triangles.size(), 3)};
  if (const auto reason = defect(soup)) extension.fail(*reason);
  scene.layers.push_back(read_layer_at_origin(extension));
  only_layer(scene).primitives = std::move(soup);
  return scene;
}

/// The node of the only layer, if that has splats that are stored as points.
std::optional<JsonView> node_with_splats(const GlbArrays& arrays, const JsonView& extension) {
  if (!has_layers(extension) || extension["layers"].size() != 1) return std::nullopt;
  const JsonView node = arrays.root()["nodes"].at(GlbArrays::index(extension["layers"].at(0)));
  const auto count = node["extensions"][tureen_extension].find("splat_count");
  return count && count->natural(GlbArrays::max_count) > 0 ? std::optional(node) : std::nullopt;
}

Scene read_splat_preview(GlbArrays& arrays, const JsonView& extension, const JsonView& node) {
  Scene scene;
  read_info(extension, scene);
  Layer& layer = scene.layers.emplace_back(read_layer_of_node(node));
  layer.primitives = read_splats(arrays, node, node["extensions"][tureen_extension]["splat_count"],
                                 {.max_degree = 0});
  return scene;
}

/// Returns the size as tureen_glb_preview_size does. Reads the scene into `wanted`, unless that is
/// null or `prefix` is too short.
std::optional<PreviewSize> preview(std::span<const std::byte> prefix, const std::string& name,
                                   std::optional<Scene>* wanted) {
  constexpr PreviewSize none;
  Input input = Input::memory(name, prefix);
  if (!is_glb(input))
    return input.size() < sizeof(std::uint32_t) ? std::nullopt : std::optional(none);
  const std::optional<GlbContainer> glb = read_glb_beginning(input);
  if (!glb) return std::nullopt;
  if (!is_tureen_glb(*glb)) return none;
  GlbArrays arrays(input, *glb);
  const JsonView extension = tureen_extension_of(arrays);
  if (const auto node = node_with_splats(arrays, extension)) {
    const std::uint64_t size =
        splats_end(arrays, *node, (*node)["extensions"][tureen_extension]["splat_count"], 0);
    if (wanted && size <= prefix.size()) *wanted = read_splat_preview(arrays, extension, *node);
    return PreviewSize{size, true};
  }
  const std::optional<PreviewLayout> layout = preview_layout(arrays, extension);
  if (!layout) return none;
  if (wanted && layout->size() <= prefix.size())
    *wanted = read_preview(arrays, extension, *layout, prefix);
  return PreviewSize{layout->size(), false};
}

}  // namespace

std::optional<PreviewSize> tureen_glb_preview_size(std::span<const std::byte> prefix,
                                                   const std::string& name) {
  return preview(prefix, name, nullptr);
}

std::optional<Scene> read_tureen_glb_preview(std::span<const std::byte> prefix,
                                             const std::string& name) {
  std::optional<Scene> scene;
  preview(prefix, name, &scene);
  return scene;
}

}  // namespace tureen
