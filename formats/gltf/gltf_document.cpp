#include "formats/gltf/gltf_document.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <limits>
#include <string_view>
#include <utility>

#include "base/json/json_limits.hpp"
#include "formats/common/uri.hpp"
#include "image/png.hpp"

namespace tureen {

namespace {

/// Extensions that a file may require. The mesh and texture extensions are applied; materials are
/// always drawn unlit.
constexpr std::array known_extensions = {"KHR_gaussian_splatting",     "KHR_materials_ior",
                                         "KHR_materials_transmission", "KHR_materials_unlit",
                                         "KHR_mesh_quantization",      "KHR_texture_transform"};

/// Extensions that a file may require although they are not drawn: lights, and what refines a
/// material whose core glTF describes. A remark names them.
constexpr std::array refinements = {
    "KHR_lights_punctual",       "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",   "KHR_materials_diffuse_transmission",
    "KHR_materials_dispersion",  "KHR_materials_emissive_strength",
    "KHR_materials_iridescence", "KHR_materials_sheen",
    "KHR_materials_specular",    "KHR_materials_variants",
    "KHR_materials_volume"};

/// Splats in an SPZ file: the extension, and the name that its draft and older writers also use.
constexpr std::string_view spz_prefix = "KHR_gaussian_splatting_compression_spz";

/// Compressed buffer views.
constexpr std::string_view meshopt_extension = "EXT_meshopt_compression";

/// A hint for a file that requires an extension that is not supported; "" without one.
std::string way_out(const std::string& extension) {
  if (extension.starts_with(spz_prefix))
    return "its splats are an SPZ file; tureen convert IN.glb OUT.glb converts it";
  if (extension == "KHR_draco_mesh_compression" || extension == "KHR_meshopt_compression" ||
      extension == meshopt_extension)
    return "gltf-transform copy IN.glb OUT.glb decompresses it";
  if (extension == "KHR_texture_basisu")
    return "gltf-transform ktxdecompress IN.glb OUT.glb decompresses it";
  return {};
}

bool is_applied(const std::string& extension, const GltfDecoders& decoders) {
  return std::find(known_extensions.begin(), known_extensions.end(), extension) !=
             known_extensions.end() ||
         (decoders.spz && extension.starts_with(spz_prefix)) ||
         (decoders.meshopt && extension == meshopt_extension);
}

/// tinygltf's messages as one line without a full stop.
std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  while (!text.empty() && (text.back() == ' ' || text.back() == '.')) text.pop_back();
  return text.empty() ? "is not valid glTF" : text;
}

/// Whether tinygltf would misread this index or enumeration. It stores them as int without the
/// upper bits, so vertex 2^32 becomes vertex 0.
bool is_beyond_int(const nlohmann::json& index) {
  return index.is_number_integer() &&
         std::abs(index.get<double>()) > std::numeric_limits<int>::max();
}

/// Whether `value` contains a number that is_beyond_int where an index or an enumeration is
/// expected: in the members `keys`, which include all "attributes" and "sparse". `place` then
/// receives its path below `value`. The path is built on the way back, because names may be long
/// and values many.
bool find_beyond_int(const nlohmann::json& value, bool are_indices, std::string& place) {
  static constexpr std::array<std::string_view, 18> keys = {
      "attributes", "buffer",  "bufferView", "camera", "children", "componentType",
      "index",      "indices", "material",   "mesh",   "mode",     "nodes",
      "sampler",    "scene",   "skin",       "source", "sparse",   "texCoord"};
  if (!value.is_structured()) return are_indices && is_beyond_int(value);
  for (const auto& [key, member] : value.items()) {
    // Lists and objects of indices contain indices; the objects of a list do not.
    const bool next = value.is_array()
                          ? are_indices && !member.is_object()
                          : are_indices || std::find(keys.begin(), keys.end(), key) != keys.end();
    if (key == "extras" || !find_beyond_int(member, next, place)) continue;
    place.insert(0, value.is_array() ? "[" + key + "]" : "." + key);
    return true;
  }
  return false;
}

/// Values and keys.
std::uint64_t count_values(const nlohmann::json& value) {
  std::uint64_t count = value.is_object() ? 1 + value.size() : 1;
  if (value.is_structured())
    for (const nlohmann::json& member : value) count += count_values(member);
  return count;
}

}  // namespace

GltfDocument::GltfDocument(Input& input, GlbContainer glb, std::filesystem::path folder,
                           const GltfDecoders& decoders)
    : input_(input), glb_(std::move(glb)), folder_(std::move(folder)), decoders_(decoders) {
  const JsonView root(glb_.json, input_.name());
  const JsonView asset = root["asset"];
  const auto minimum = asset.find("minVersion");
  const std::string& version = minimum ? minimum->text() : asset["version"].text();
  if (version.substr(0, 2) != "2." || (minimum && version != "2.0"))
    (minimum ? *minimum : asset["version"]).fail("glTF " + version + "; only 2.0 is supported");
  if (const auto required = root.find("extensionsRequired"))
    for (std::size_t i = 0; i < required->size(); ++i) {
      const std::string& name = required->at(i).text();
      if (!is_applied(name, decoders_) &&
          std::find(refinements.begin(), refinements.end(), name) == refinements.end())
        required->at(i).fail("the file requires the extension " + name + ", which is not supported",
                             way_out(name));
    }
  if (const auto used = root.find("extensionsUsed"))
    for (std::size_t i = 0; i < used->size(); ++i)
      has_meshopt_ |= decoders_.meshopt && used->at(i).text() == meshopt_extension;
  if (const auto list = root.find("buffers")) buffers_.resize(list->size());
  parse();
}

std::vector<std::string> GltfDocument::dropped_extensions() const {
  constexpr std::size_t most = 8;
  std::vector<std::string> names;
  // A required extension is a used one, but not every file lists it twice.
  for (const char* key : {"extensionsRequired", "extensionsUsed"}) {
    const auto list = root().find(key);
    for (std::size_t i = 0; list && i < list->size() && names.size() < most; ++i) {
      const std::string& name = list->at(i).text();
      // Another remark names ours.
      if (!is_applied(name, decoders_) && !name.starts_with("TUREEN_") &&
          std::find(names.begin(), names.end(), name) == names.end())
        names.push_back(name);
    }
  }
  return names;
}

/// Counts the memory of tinygltf's model. Its structures are large: {} becomes a material of two
/// kilobytes.
void GltfDocument::take_model_memory() const {
  constexpr std::pair<const char*, std::size_t> lists[] = {
      {"accessors", sizeof(tinygltf::Accessor)}, {"bufferViews", sizeof(tinygltf::BufferView)},
      {"cameras", sizeof(tinygltf::Camera)},     {"materials", sizeof(tinygltf::Material)},
      {"meshes", sizeof(tinygltf::Mesh)},        {"nodes", sizeof(tinygltf::Node)},
      {"samplers", sizeof(tinygltf::Sampler)},   {"scenes", sizeof(tinygltf::Scene)},
      {"textures", sizeof(tinygltf::Texture)}};
  // Three times, because vectors double, and the old array still exists while it is copied.
  for (const auto& [name, each] : lists)
    if (const auto list = root().find(name)) take_memory(list->size(), 3 * each, list->path());
  const auto meshes = root().find("meshes");
  for (std::size_t i = 0; meshes && i < meshes->size(); ++i)
    if (const auto list = meshes->at(i).find("primitives"))
      take_memory(list->size(), 3 * sizeof(tinygltf::Primitive), list->path());
}

void GltfDocument::parse() {
  // The copy, tinygltf's own copy, and its values for extensions and extras.
  take_memory(count_values(glb_.json), 2 * json_value_bytes + sizeof(tinygltf::Value), "");
  take_model_memory();
  nlohmann::json lean = glb_.json;
  for (const char* key : {"buffers", "images", "animations", "skins", "extensions", "extras"})
    lean.erase(key);
  if (std::string place; find_beyond_int(lean, false, place))
    fail(place.substr(1), "is beyond 2147483647");
  // tinygltf ignores an offset or a size that is not an integer. Such a file would be misread
  // without an error.
  for (const char* list : {"accessors", "bufferViews"}) {
    const auto view = root().find(list);
    for (std::size_t i = 0; view && i < view->size(); ++i)
      for (const char* key : {"byteOffset", "byteLength", "byteStride", "count", "bufferView"})
        if (const auto member = view->at(i).find(key)) lean[list][i][key] = member->natural();
  }
  const std::string text = lean.dump();
  // At most as long as the file's text plus about two dozen characters per number; both were
  // counted when it was parsed.
  take_memory(2 * text.size(), 1, "");
  if (text.size() > std::numeric_limits<unsigned int>::max()) fail("", "more than 4 GiB of JSON");
  tinygltf::TinyGLTF loader;
  std::string error, warning;
  bool parsed = false;
  try {
    parsed = loader.LoadASCIIFromString(&model_, &error, &warning, text.data(),
                                        static_cast<unsigned int>(text.size()), "");
  } catch (const std::exception& exception) {
    error += exception.what();
  }
  // tinygltf reports errors in some parts, skips these parts and continues: a material whose colour
  // has three numbers would lose its texture, too.
  if (!parsed || !error.empty()) fail("", "not valid glTF: " + one_line(error));
}

void GltfDocument::fail(const std::string& where, const std::string& reason,
                        const std::string& hint) const {
  throw InputError({input_.name()}, where.empty() ? reason : where + ": " + reason, hint);
}

void GltfDocument::take_memory(std::uint64_t elements, std::size_t each,
                               const std::string& where) const {
  MemoryBudget budget = input_.budget();
  if (!budget.take(elements, each))
    fail(where, budget.refusal(where.empty() ? "the scene" : "it"), max_memory_hint);
}

std::uint64_t GltfDocument::vertex_budget() const {
  return std::max(std::uint64_t(1) << 24, loaded_bytes_);
}

std::vector<std::byte> GltfDocument::load_uri(const JsonView& uri,
                                              std::optional<std::uint64_t> size) {
  try {
    take_memory(uri.text().size() / 4, 3, uri.path());
    if (auto bytes = decode_data_uri(uri.text())) {
      if (size && bytes->size() < *size)
        uri.fail("holds " + std::to_string(bytes->size()) + " bytes, expected " +
                 std::to_string(*size));
      if (size) bytes->resize(static_cast<std::size_t>(*size));
      return *std::move(bytes);
    }
    Input file = Input::open(resolve_in_folder(folder_, uri.text()), input_.budget());
    if (!size) return file.read_rest();
    return file.read_values<std::byte>(*size, "the buffer");
  } catch (const UriError& error) {
    uri.fail(error.reason);
  } catch (const InputError& error) {
    // An error in the scene's own file is complete; an error in a referenced file needs the place
    // of the reference.
    if (error.position().file == input_.name()) throw;
    uri.fail(error.without_hint(), error.hint());
  }
}

std::vector<std::byte> GltfDocument::load_buffer(std::size_t index, std::uint64_t size) {
  const JsonView json = root()["buffers"].at(index);
  if (const auto uri = json.find("uri")) return load_uri(*uri, size);
  if (index != 0 || glb_.binary_offset == 0) json.fail("has no uri and no binary chunk");
  if (size > glb_.binary_size)
    json.fail("needs " + std::to_string(size) + " bytes; the binary chunk has " +
              std::to_string(glb_.binary_size));
  input_.seek(glb_.binary_offset);
  return input_.read_values<std::byte>(size, "the binary chunk");
}

std::span<const std::byte> GltfDocument::buffer(int index, const std::string& where) {
  if (index < 0 || std::size_t(index) >= buffers_.size())
    fail(where, "names buffer " + std::to_string(index) + " of " + std::to_string(buffers_.size()));
  auto& bytes = buffers_[std::size_t(index)];
  if (!bytes) {
    const JsonView json = root()["buffers"].at(std::size_t(index));
    bytes = load_buffer(std::size_t(index), json["byteLength"].natural());
    loaded_bytes_ += bytes->size();
  }
  return *bytes;
}

std::span<const std::byte> GltfDocument::view_bytes(int view, const std::string& where) {
  if (view < 0 || std::size_t(view) >= model_.bufferViews.size())
    fail(where, "names buffer view " + std::to_string(view) + " of " +
                    std::to_string(model_.bufferViews.size()));
  const std::string name = "bufferViews[" + std::to_string(view) + "]";
  if (has_meshopt_)
    if (const auto extensions = root()["bufferViews"].at(std::size_t(view)).find("extensions"))
      if (const auto extension = extensions->find(meshopt_extension.data()))
        return decoded_view(view, *extension);
  const tinygltf::BufferView& json = model_.bufferViews[std::size_t(view)];
  return buffer_bytes(json.buffer, json.byteOffset, json.byteLength, name);
}

std::span<const std::byte> GltfDocument::buffer_bytes(int index, std::uint64_t offset,
                                                      std::uint64_t size,
                                                      const std::string& where) {
  const auto bytes = buffer(index, where);
  if (offset > bytes.size() || size > bytes.size() - offset)
    fail(where, "bytes " + std::to_string(offset) + " + " + std::to_string(size) +
                    " reach past the end of its buffer at " + std::to_string(bytes.size()));
  return bytes.subspan(std::size_t(offset), std::size_t(size));
}

/// The bytes of a compressed view. The sizes that glTF states twice must agree.
std::span<const std::byte> GltfDocument::decoded_view(int view, const JsonView& extension) {
  if (const auto found = decoded_views_.find(view); found != decoded_views_.end())
    return found->second;
  const auto offset = extension.find("byteOffset");
  const auto stored = buffer_bytes(
      int(extension["buffer"].natural(std::numeric_limits<int>::max())),
      offset ? offset->natural() : 0, extension["byteLength"].natural(), extension.path());
  const tinygltf::BufferView& json = model_.bufferViews[std::size_t(view)];
  const std::uint64_t stride = extension["byteStride"].natural();
  if ((json.byteStride != 0 && json.byteStride != stride) || stride == 0 ||
      json.byteLength / stride != extension["count"].natural() || json.byteLength % stride != 0)
    extension.fail("its count and byteStride differ from those of its view");
  std::vector<std::byte> bytes = decoders_.meshopt(extension, stored, input_.budget());
  return decoded_views_[view] = std::move(bytes);
}

GltfDocument::Elements GltfDocument::elements(int view, std::uint64_t offset, std::uint64_t count,
                                              std::size_t each, const std::string& where) {
  const auto bytes = view_bytes(view, where);
  std::size_t stride = model_.bufferViews[std::size_t(view)].byteStride;
  if (stride == 0) stride = each;
  if (stride < each)
    fail(where, "its stride of " + std::to_string(stride) + " bytes is less than an element's " +
                    std::to_string(each));
  // 252 is glTF's own limit, so the product below cannot overflow.
  if (stride > 252 && stride != each)
    fail(where, "its stride of " + std::to_string(stride) + " bytes is beyond 252");
  if (offset > bytes.size() || each > bytes.size() - offset ||
      count - 1 > (bytes.size() - offset - each) / stride)
    fail(where, std::to_string(count) + " elements of " + std::to_string(each) +
                    " bytes from byte " + std::to_string(offset) +
                    " reach past the end of its buffer view of " + std::to_string(bytes.size()));
  return {bytes.data() + offset, stride};
}

Image8 GltfDocument::image(int index) {
  const JsonView images = root()["images"];
  const JsonView json = images.at(index < 0 ? images.size() : std::size_t(index));
  const auto decode = [&](std::span<const std::byte> bytes) {
    try {
      return decode_image(bytes, input_.name(), input_.budget());
    } catch (const InputError& error) {
      json.fail(error.reason(), error.hint());
    }
  };
  if (const auto uri = json.find("uri")) {
    PassingMemory passing(input_.budget());
    Image8 result = decode(load_uri(*uri, std::nullopt));
    passing.keep(result.pixels.size() * sizeof result.pixels[0]);
    return result;
  }
  const auto view = int(json["bufferView"].natural(std::numeric_limits<int>::max()));
  return decode(view_bytes(view, json.path()));
}

}  // namespace tureen
