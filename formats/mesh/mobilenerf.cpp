#include "formats/mesh/mobilenerf.hpp"

#include <array>
#include <charconv>
#include <glm/trigonometric.hpp>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>

#include "base/extension.hpp"
#include "base/json/json_file.hpp"
#include "formats/common/uri.hpp"
#include "formats/mesh/mesh_remarks.hpp"
#include "formats/mesh/obj.hpp"
#include "image/png.hpp"

namespace tureen {

namespace {

namespace fs = std::filesystem;

/// Far more than any published scene has; bounds the list of missing shapes.
constexpr int max_shapes = 1024;

/// The scene's folder: `path` itself, or the folder of the mlp.json or .obj at `path`.
fs::path folder_of(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) return path;
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

/// Layer `index` of mlp.json, transposed from [input][output] to [output][input].
DenseLayer read_layer(const nlohmann::json& json, const std::string& file, int index, int inputs,
                      int outputs) {
  const std::string name = std::to_string(index);
  const nlohmann::json& rows = json_at(json, (name + "_weights").c_str(), file);
  if (!rows.is_array() || rows.size() != std::size_t(inputs))
    throw InputError({file},
                     name + "_weights is not a list of " + std::to_string(inputs) + " rows");
  DenseLayer layer{inputs, outputs, std::vector<float>(std::size_t(inputs) * outputs),
                   json_floats(json_at(json, (name + "_bias").c_str(), file), std::size_t(outputs),
                               file, name + "_bias")};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto row = json_floats(rows[i], std::size_t(outputs), file,
                                 name + "_weights[" + std::to_string(i) + "]");
    for (std::size_t o = 0; o < row.size(); ++o)
      layer.weights[o * std::size_t(inputs) + i] = row[o];
  }
  return layer;
}

/// Rewrites the first layer for inputs as they are stored (see mobilenerf.hpp).
void take_plain_inputs(DenseLayer& layer) {
  for (int o = 0; o < layer.outputs; ++o) {
    float* w = &layer.weights[std::size_t(o) * layer.inputs];
    // w (2 a - 1) + b = (2 w) a + (b - w)
    for (const int alpha : {3, 7}) {
      layer.biases[std::size_t(o)] -= w[alpha];
      w[alpha] *= 2.0f;
    }
    // w8 x + w9 (-z) + w10 y
    const float y = w[10], z = -w[9];
    w[9] = y;
    w[10] = z;
  }
}

struct Network {
  ColorMlp mlp;
  int shapes = 0;
};

Network read_network(const fs::path& folder, const MemoryBudget& budget) {
  Input input = open_in_folder(folder, "mlp.json", budget);
  const nlohmann::json json = read_json(input);
  const std::string& file = input.name();
  Network network;
  network.mlp = {.layers = {read_layer(json, file, 0, 11, 16), read_layer(json, file, 1, 16, 16),
                            read_layer(json, file, 2, 16, 3)},
                 .encoding = DirectionEncoding::xyz,
                 .view = ViewConvention::eye_to_surface,
                 .blend_channel = std::nullopt};
  take_plain_inputs(network.mlp.layers.front());
  if (const auto why = defect(network.mlp, 8)) throw InputError({file}, *why);
  const nlohmann::json& shapes = json_at(json, "obj_num", file);
  if (!shapes.is_number_integer() || shapes < 1 || shapes > max_shapes)
    throw InputError({file},
                     "obj_num is not a whole number from 1 to " + std::to_string(max_shapes));
  network.shapes = shapes.get<int>();
  return network;
}

/// "shape3.obj" is {3, -1}, "shape3_1.obj" is {3, 1}; nullopt for other names.
std::optional<std::pair<int, int>> shape_and_piece(std::string_view name) {
  constexpr std::string_view begin = "shape", end = ".obj";
  if (name.size() <= begin.size() + end.size() || name.substr(0, begin.size()) != begin ||
      name.substr(name.size() - end.size()) != end)
    return std::nullopt;
  const char* at = name.data() + begin.size();
  const char* const stop = name.data() + name.size() - end.size();
  int shape = 0, piece = -1;
  auto result = std::from_chars(at, stop, shape);
  if (result.ec == std::errc() && result.ptr != stop && *result.ptr == '_')
    result = std::from_chars(result.ptr + 1, stop, piece);
  if (result.ec != std::errc() || result.ptr != stop || shape < 0) return std::nullopt;
  return std::pair(shape, piece);
}

/// The .obj files of each shape, in the order of their pieces.
std::map<int, std::map<int, fs::path>> find_shapes(const fs::path& folder) {
  std::map<int, std::map<int, fs::path>> shapes;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (const auto found = shape_and_piece(entry.path().filename().string()))
      shapes[found->first][found->second] = entry.path();
  if (error) throw InputError({folder.string()}, "cannot be listed: " + error.message());
  return shapes;
}

/// Appends one .obj, whose faces all have the material `material`.
void append(TriangleSoup& soup, UvTextures& textures, const fs::path& path, std::uint32_t material,
            MemoryBudget budget) {
  Input input = open_in_folder(path.parent_path(), path.filename().string(), budget);
  const std::uint64_t before = budget.taken();
  const ObjMesh mesh = read_obj(input, {.only_uv = true});
  const std::uint64_t passing = budget.taken() - before;
  input.make_room_in(soup.positions, mesh.positions.size(), "the vertices");
  input.make_room_in(textures.uv, mesh.uv.size(), "the vertices");
  input.make_room_in(soup.triangles, mesh.triangles.size(), "the faces");
  input.make_room_in(textures.material_of_face, mesh.triangles.size(), "the faces");
  const std::size_t first = soup.positions.size();
  if (mesh.positions.size() > std::numeric_limits<std::uint32_t>::max() - first)
    input.fail_at(0, "more vertices than 32 bits can count");
  soup.positions.insert(soup.positions.end(), mesh.positions.begin(), mesh.positions.end());
  for (const glm::vec2& uv : mesh.uv)
    // OBJ's v = 0 is the last row of the image. Computed in double and rounded once, because these
    // coordinates are texel centres.
    textures.uv.emplace_back(uv.x, static_cast<float>(1.0 - double(uv.y)));
  for (const glm::uvec3& triangle : mesh.triangles)
    soup.triangles.push_back(triangle + glm::uvec3(static_cast<std::uint32_t>(first)));
  textures.material_of_face.resize(soup.triangles.size(), material);
  budget.give_back(passing);
}

/// Two images of equal size and the material that samples them.
void append_material(UvTextures& textures, const std::array<fs::path, 2>& features,
                     const MemoryBudget& budget) {
  UvMaterial material;
  material.wrap_u = material.wrap_v = UvMaterial::Wrap::clamp;
  material.filter = UvMaterial::Filter::nearest;
  material.mask_channel = 0;
  material.mask_threshold = 0.5f / 255.0f;  // between the bytes 0 (a hole) and 1
  for (const fs::path& path : features) {
    Input input = open_in_folder(path.parent_path(), path.filename().string(), budget);
    material.images.push_back(static_cast<std::uint32_t>(textures.images.size()));
    textures.images.push_back(read_image(input));
  }
  const Image8& first = textures.images[material.images[0]];
  const Image8& second = textures.images[material.images[1]];
  if (first.width != second.width || first.height != second.height)
    throw InputError({features[1].string()},
                     std::to_string(second.width) + " x " + std::to_string(second.height) +
                         " pixels, but " + features[0].filename().string() + " has " +
                         std::to_string(first.width) + " x " + std::to_string(first.height));
  textures.materials.push_back(std::move(material));
}

/// The initial camera of the published pages, in the coordinates of the .obj files. The pages scale
/// camera and object by 1/10, which changes no pixel.
Camera published_camera() {
  Camera camera =
      look_at({0.0, 2.0, 3.464}, glm::dvec3(0.0), {0.0, 1.0, 0.0}, glm::radians(39.0), 800, 800);
  camera.name = "published";
  return camera;
}

}  // namespace

bool is_mobilenerf(const fs::path& path) {
  std::error_code ignored;
  const std::string name = path.filename().string();
  if (!fs::is_directory(path, ignored) && name != "mlp.json" && extension_of(path) != ".obj")
    return false;
  const fs::path mlp = folder_of(path) / "mlp.json";
  if (!fs::is_regular_file(mlp, ignored)) return false;
  try {
    Input input = open_in_folder(folder_of(path), "mlp.json", MemoryBudget());
    const nlohmann::json json = read_json(input);
    return json.is_object() && json.contains("0_weights");
  } catch (const InputError&) {
    return true;  // damaged: recognised by its name
  }
}

Scene read_mobilenerf(const fs::path& path, const ReadOptions& options) {
  const fs::path folder = folder_of(path);
  // Meshes from other programs have no mlp.json. Only a page comes here with one.
  std::error_code ignored;
  if (!fs::is_directory(path, ignored) && path.filename() != "mlp.json" &&
      fs::symlink_status(folder / "mlp.json", ignored).type() == fs::file_type::not_found)
    throw InputError(
        {path.string()},
        "the page reads an .obj only as part of a MobileNeRF scene, and its folder has no mlp.json",
        "tureen convert FILE.obj FILE.glb converts another one");
  const MemoryBudget budget;
  Network network = read_network(folder, budget);
  const auto shapes = find_shapes(folder);

  Scene scene;
  TriangleSoup soup;
  UvTextures textures;
  std::vector<int> missing, untextured;
  for (int i = 0; i < network.shapes; ++i) {
    if (options.progress) options.progress(double(i) / network.shapes);
    const auto pieces = shapes.find(i);
    if (pieces == shapes.end()) {
      missing.push_back(i);
      continue;
    }
    const std::string stem = "shape" + std::to_string(i) + ".pngfeat";
    const std::array<fs::path, 2> features{folder / (stem + "0.png"), folder / (stem + "1.png")};
    if (!fs::exists(features[0], ignored) || !fs::exists(features[1], ignored)) {
      untextured.push_back(i);
      continue;
    }
    const auto material = static_cast<std::uint32_t>(textures.materials.size());
    append_material(textures, features, budget);
    for (const auto& [piece, file] : pieces->second) append(soup, textures, file, material, budget);
  }
  for (const auto& [kind, shapes_of_kind] : {std::pair(&remarks::shapes_missing, &missing),
                                             std::pair(&remarks::shapes_untextured, &untextured)}) {
    if (shapes_of_kind->empty()) continue;
    std::vector<std::uint64_t> indices(shapes_of_kind->begin(), shapes_of_kind->end());
    scene.info.remarks.push_back(
        {kind, {{"shapes", std::move(indices)}, {"all", std::uint64_t(network.shapes)}}});
  }
  if (textures.materials.empty())
    throw InputError({folder.string()},
                     "all " + std::to_string(network.shapes) +
                         " shapes in mlp.json lack their .obj or their feature images");

  textures.mlp = std::move(network.mlp);
  soup.appearance = std::move(textures);
  scene.layers.push_back({.primitives = std::move(soup)});
  scene.cameras.push_back(published_camera());
  scene.info.name = fs::absolute(folder / "").lexically_normal().parent_path().filename().string();
  scene.info.source = "MobileNeRF";
  scene.info.up = {0.0f, 1.0f, 0.0f};
  scene.info.background = glm::vec3(1.0f);
  if (options.progress) options.progress(1.0);
  return scene;
}

}  // namespace tureen
