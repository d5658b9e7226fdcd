#include "formats/gltf/gltf_splats.hpp"

#include <glm/gtc/matrix_transform.hpp>
#include <numeric>
#include <string_view>
#include <utility>

#include "formats/common/format_remarks.hpp"
#include "formats/common/splat_values.hpp"
#include "formats/gltf/gltf_accessor.hpp"
#include "formats/gltf/gltf_remarks.hpp"
#include "scene/edit/morton_order.hpp"
#include "scene/edit/splat_edits.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen {

namespace {

constexpr char splatting[] = "KHR_gaussian_splatting";
constexpr char spz_extension[] = "KHR_gaussian_splatting_compression_spz_2";

/// The last degree of KHR_gaussian_splatting.
constexpr int last_khr_degree = 3;

std::string splatting_attribute(const std::string& name) {
  return std::string(splatting) + ":" + name;
}

std::string coefficient_name(int degree, int order) {
  return splatting_attribute("SH_DEGREE_" + std::to_string(degree) + "_COEF_" +
                             std::to_string(order));
}

/// The object of the SPZ file in an object of KHR_gaussian_splatting, or null. The draft and older
/// writers also use the second name.
const tinygltf::Value* spz_of(const tinygltf::Value& object) {
  if (!object.IsObject() || !object.Has("extensions")) return nullptr;
  const tinygltf::Value& extensions = object.Get("extensions");
  for (const char* name : {spz_extension, "KHR_gaussian_splatting_compression_spz"})
    if (extensions.IsObject() && extensions.Has(name)) return &extensions.Get(name);
  return nullptr;
}

/// Three floats a splat as vectors.
std::vector<glm::vec3> as_vec3(const std::vector<float>& values) {
  std::vector<glm::vec3> result(values.size() / 3);
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
  return result;
}

}  // namespace

bool has_splats(const tinygltf::Primitive& primitive) {
  return primitive.extensions.contains(splatting);
}

void GltfSplatBuilder::add_mesh(int index, const Node& node, const std::string& where) {
  const tinygltf::Mesh& mesh = document_.model().meshes[std::size_t(index)];
  for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
    if (!has_splats(mesh.primitives[i])) continue;
    if (layers_.size() == max_layers)
      document_.fail(where, "more than " + std::to_string(max_layers) + " primitives with splats");
    Layer layer{.name = node.name, .world_from_layer = node.world_from_node};
    if (const auto reason = defect(layer))
      document_.fail(where, "splats need a node that neither stretches nor shears: " + *reason);
    const std::string place =
        "meshes[" + std::to_string(index) + "].primitives[" + std::to_string(i) + "]";
    const tinygltf::Value& object = mesh.primitives[i].extensions.at(splatting);
    if (const tinygltf::Value* spz = spz_of(object)) {
      const bool is_older = !object.Has("kernel") && !object.Has("colorSpace");
      if (!is_older) check_method(mesh.primitives[i], place);
      add_spz(*spz, std::move(layer), is_older, place + ".extensions." + splatting);
      continue;
    }
    Splats splats = read(mesh.primitives[i], place);
    if (const auto reason = defect(splats)) document_.fail(place, *reason);
    layer.primitives = std::move(splats);
    layers_.push_back(std::move(layer));
  }
}

std::vector<Remark> GltfSplatBuilder::remarks() const {
  std::vector<Remark> result;
  if (dropped_ > 0)
    result.push_back({&remarks::splats_dropped, {{"dropped", dropped_}, {"all", total_}}});
  if (is_linear_) result.push_back({&remarks::splat_colors_linear});
  result.insert(result.end(), spz_remarks_.begin(), spz_remarks_.end());
  return result;
}

void GltfSplatBuilder::add_spz(const tinygltf::Value& extension, Layer layer, bool is_older,
                               const std::string& where) {
  const std::string place = where + ".extensions." + spz_extension;
  if (!read_spz_)
    document_.fail(place, "splats in SPZ files are not supported here",
                   "tureen convert IN.glb OUT.glb stores them as they are");
  if (!extension.IsObject() || !extension.Has("bufferView") || !extension.Get("bufferView").IsInt())
    document_.fail(place, "lacks \"bufferView\"");
  const int view = extension.Get("bufferView").Get<int>();
  Input input = Input::memory(
      document_.name() + ", the SPZ file in bufferViews[" + std::to_string(view) + "]",
      document_.view_bytes(view, place), document_.budget());
  ReadOptions options{.max_splats = options_.max_splats, .keep_rows = options_.keep_rows};
  Scene scene = read_spz_(input, options);
  Layer& read = scene.layers.front();
  total_ += count(std::get<Splats>(read.primitives));
  if (total_ > document_.vertex_budget())
    document_.fail(where, "the scene's nodes repeat its meshes to more than " +
                              std::to_string(document_.vertex_budget()) + " splats");
  // The reader has turned the stored axes, right, up, back, to right, down, front.
  const glm::dvec3 signs = is_older ? glm::dvec3(1, -1, -1) : glm::dvec3(-1, -1, 1);
  layer.world_from_layer =
      layer.world_from_layer * glm::scale(glm::dmat4(1), signs) * read.world_from_layer;
  layer.primitives = std::move(read.primitives);
  layers_.push_back(std::move(layer));
  if (is_older)
    spz_remarks_.push_back({&remarks::spz_axes_stored});
  else
    spz_remarks_.push_back({&remarks::spz_axes_of_draft, {{"extension", spz_extension}}});
  for (Remark& remark : scene.info.remarks)
    if (std::string_view(remark.kind->setting) != "up") spz_remarks_.push_back(std::move(remark));
}

/// Checks the values of the extension's object.
void GltfSplatBuilder::check_method(const tinygltf::Primitive& primitive,
                                    const std::string& where) {
  const tinygltf::Value& object = primitive.extensions.at(splatting);
  const std::string place = where + ".extensions." + splatting;
  const auto text = [&](const char* key, const std::string& missing) {
    if (!object.IsObject() || !object.Has(key)) {
      if (missing.empty()) document_.fail(place, std::string("lacks \"") + key + "\"");
      return missing;
    }
    if (!object.Get(key).IsString()) document_.fail(place + "." + key, "expected a string");
    return object.Get(key).Get<std::string>();
  };
  if (primitive.mode != TINYGLTF_MODE_POINTS)
    document_.fail(where, "splats need mode 0 (points), not " + std::to_string(primitive.mode));
  if (primitive.indices >= 0) document_.fail(where, "splats with indices are not supported");
  if (const std::string kernel = text("kernel", ""); kernel != "ellipse")
    document_.fail(place + ".kernel",
                   "the kernel \"" + kernel + "\" is not supported; only \"ellipse\" is");
  const std::string space = text("colorSpace", "");
  if (space != "srgb_rec709_display" && space != "lin_rec709_display")
    document_.fail(place + ".colorSpace",
                   "the colour space \"" + space +
                       "\" is not supported; only srgb_rec709_display and lin_rec709_display are");
  if (const std::string projection = text("projection", "perspective"); projection != "perspective")
    document_.fail(place + ".projection", "the projection \"" + projection +
                                              "\" is not supported; only \"perspective\" is");
  is_linear_ = is_linear_ || space == "lin_rec709_display";
}

std::vector<float> GltfSplatBuilder::attribute(const tinygltf::Primitive& primitive,
                                               const std::string& name, int components,
                                               const std::string& where) {
  const auto found = primitive.attributes.find(name);
  if (found == primitive.attributes.end())
    document_.fail(where, "splats need the attribute " + name + ", which is missing");
  const std::size_t elements = accessor_count(document_, found->second);
  if (elements != accessor_count(document_, primitive.attributes.at("POSITION")))
    document_.fail(where + ".attributes." + name, "does not have as many elements as POSITION");
  return read_float_elements(document_, found->second, {components}, all_).values;
}

void GltfSplatBuilder::require_normalized(const tinygltf::Primitive& primitive,
                                          const std::string& name, const std::string& where) const {
  const auto found = primitive.attributes.find(name);
  if (found == primitive.attributes.end()) return;
  const tinygltf::Accessor& accessor =
      document_.model().accessors[std::size_t(found->second)];  // attribute() has checked it
  if (accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT && !accessor.normalized)
    document_.fail(where + ".attributes." + name, "holds integers that are not normalised");
}

/// The degree whose coefficients, and those of all degrees below, are there.
int GltfSplatBuilder::degree_of(const tinygltf::Primitive& primitive,
                                const std::string& where) const {
  int degree = 0;
  for (int l = 1; l <= last_khr_degree; ++l) {
    int there = 0;
    for (int order = 0; order < 2 * l + 1; ++order)
      there += primitive.attributes.contains(coefficient_name(l, order)) ? 1 : 0;
    if (there == 0) continue;
    if (there < 2 * l + 1 || degree < l - 1)
      document_.fail(where, "the harmonics of degree " + std::to_string(l) +
                                " or of a lower one are incomplete");
    degree = l;
  }
  return degree;
}

Splats GltfSplatBuilder::read(const tinygltf::Primitive& primitive, const std::string& where) {
  check_method(primitive, where);
  if (!primitive.attributes.contains("POSITION"))
    document_.fail(where, "splats need the attribute POSITION, which is missing");
  const std::size_t count = accessor_count(document_, primitive.attributes.at("POSITION"));
  total_ += count;
  if (count > all_.size()) document_.make_room_in(all_, count - all_.size(), where);
  all_.resize(count);
  std::iota(all_.begin(), all_.end(), 0u);
  if (total_ > document_.vertex_budget())
    document_.fail(where, "the scene's nodes repeat its meshes to more than " +
                              std::to_string(document_.vertex_budget()) + " splats");

  Splats splats{.profile = *profile_named("3dgs")};
  splats.color.degree = degree_of(primitive, where);
  const std::size_t stride = harmonics::count(splats.color.degree);
  Gaussians& gaussians = splats.kernel.emplace<Gaussians>();
  document_.take_memory(count,
                        bytes_per_splat(splats.kernel, splats.color.degree) +
                            (options_.keep_rows ? sizeof splats.rows[0] : 0),
                        where);
  PassingMemory passing(document_.budget());
  document_.take_memory(count, sizeof(std::uint8_t), where);
  gaussians.centers = as_vec3(attribute(primitive, "POSITION", 3, where));
  gaussians.scales = as_vec3(attribute(primitive, splatting_attribute("SCALE"), 3, where));
  gaussians.opacity = attribute(primitive, splatting_attribute("OPACITY"), 1, where);
  require_normalized(primitive, splatting_attribute("OPACITY"), where);
  const std::vector<float> xyzw = attribute(primitive, splatting_attribute("ROTATION"), 4, where);
  require_normalized(primitive, splatting_attribute("ROTATION"), where);
  gaussians.rotations.reserve(count);
  for (std::size_t i = 0; i < 4 * count; i += 4)
    gaussians.rotations.push_back(
        unit_rotation(glm::dquat(xyzw[i + 3], xyzw[i], xyzw[i + 1], xyzw[i + 2]))
            .value_or(glm::quat(0, 0, 0, 0)));  // is_valid() rejects it

  splats.color.coefficients.resize(count * stride);
  std::size_t k = 0;
  for (int degree = 0; degree <= splats.color.degree; ++degree)
    for (int order = 0; order < 2 * degree + 1; ++order, ++k) {
      PassingMemory one(document_.budget());
      const std::vector<float> plane =
          attribute(primitive, coefficient_name(degree, order), 3, where);
      for (std::size_t i = 0; i < count; ++i)
        splats.color.coefficients[stride * i + k] = {plane[3 * i], plane[3 * i + 1],
                                                     plane[3 * i + 2]};
    }
  if (options_.keep_rows) number_rows(splats);
  std::vector<std::uint8_t> keeps(count);
  for (std::size_t i = 0; i < count; ++i) keeps[i] = is_valid(splats, i);
  splats = keep_splats(std::move(splats), keeps);
  dropped_ += count - tureen::count(splats);
  document_.take_memory(morton_order_bytes(splats), 1, where);
  sort_in_morton_order(splats);
  return splats;
}

}  // namespace tureen
