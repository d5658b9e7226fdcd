#include <algorithm>
#include <array>
#include <cstring>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>

#include "base/json/json_file.hpp"
#include "formats/common/uri.hpp"
#include "formats/diffsoup/diffsoup_export.hpp"
#include "formats/diffsoup/diffsoup_mesh.hpp"
#include "formats/diffsoup/diffsoup_remarks.hpp"
#include "image/png.hpp"
#include "image/png_chunks.hpp"
#include "scene/lattice.hpp"

namespace tureen {

namespace {

namespace fs = std::filesystem;

struct Meta {
  int level = 5;
  glm::vec3 up{0.0f, -1.0f, 0.0f};
  glm::vec3 background{0.0f};
  std::optional<std::uint64_t> faces, vertices;
  bool ours = false;
  std::string assumed;  // reason for an assumed level; otherwise empty
};

Meta read_meta(const fs::path& folder, const MemoryBudget& budget, SceneInfo& info) {
  Meta meta;
  // A broken or cyclic link exists; Input::open reports its error.
  std::error_code ignored;
  if (fs::symlink_status(folder / "meta.json", ignored).type() == fs::file_type::not_found) {
    meta.assumed = "meta.json is missing: level 5 is assumed";
    info.up_is_assumed = true;
    info.remarks.push_back({&remarks::meta_missing});
    return meta;
  }
  Input input = open_in_folder(folder, "meta.json", budget);
  const nlohmann::json json = read_json(input);
  const std::string& file = input.name();
  const auto fail = [&](const char* reason) { throw InputError({file}, reason); };
  if (!json.is_object()) fail("not a JSON object");
  const auto vector = [&](const char* key, glm::vec3 otherwise) {
    if (!json.contains(key)) return otherwise;
    const auto numbers = json_floats(json[key], 3, file, key);
    return glm::vec3(numbers[0], numbers[1], numbers[2]);
  };
  const auto count = [&](const char* key) -> std::optional<std::uint64_t> {
    if (!json.contains(key)) return std::nullopt;
    if (!json[key].is_number_unsigned()) fail("num_faces or num_verts is not a count");
    return json[key].get<std::uint64_t>();
  };
  if (json.contains("level")) {
    const nlohmann::json& level = json["level"];
    if (!level.is_number_integer() || level < 0 || level > lattice::max_level)
      fail("\"level\" is not an integer from 0 to 7");
    meta.level = level.get<int>();
  } else {
    meta.assumed = "meta.json has no level: 5 is assumed";
    info.remarks.push_back({&remarks::level_missing});
  }
  meta.up = vector("up", meta.up);
  // In double: squares of floats overflow otherwise.
  const double length = glm::length(glm::dvec3(meta.up));
  if (!(length > 0)) fail("\"up\" has no direction");
  meta.up = glm::vec3(glm::dvec3(meta.up) / length);
  meta.background = vector("background", meta.background);
  meta.faces = count("num_faces");
  meta.vertices = count("num_verts");
  meta.ours = json.contains("writer") && json["writer"] == "tureen";
  return meta;
}

void expect_count(const fs::path& mesh, std::optional<std::uint64_t> said, std::size_t have,
                  const char* what) {
  if (said && *said != have)
    throw InputError({mesh.string()}, std::to_string(have) + " " + what + ", but meta.json has " +
                                          std::to_string(*said));
}

/// One of the two images, with `texels` pixels and a remainder below one row. `assumed` is the
/// reason for an assumed level, which is added to the error about a wrong size.
Image8 read_lut(const fs::path& folder, const char* name, std::uint64_t texels,
                const std::string& assumed, const MemoryBudget& budget) {
  Input input = open_in_folder(folder, name, budget);
  const auto bytes = input.read_rest();
  // Bit depth and colour type of IHDR, which is always the first chunk. The decoder would convert
  // other depths and types to RGBA8 and change the values.
  if (bytes.size() < 26 || !is_png(bytes)) input.fail_at(0, "not a PNG image");
  if (bytes[24] != std::byte(8) || bytes[25] != std::byte(6))
    input.fail_at(24, "not a PNG of four channels of 8 bits");
  const auto number = [&](std::size_t at) { return png_number(std::span(bytes).subspan(at)); };
  const std::uint64_t width = number(16), height = number(20);
  const std::uint64_t expected = width == 0 ? 0 : (texels + width - 1) / width;
  if (width == 0 || height != expected)
    input.fail_at(16, std::to_string(width) + " x " + std::to_string(height) +
                          " pixels cannot be " + std::to_string(texels) + " texels in rows of " +
                          std::to_string(width) + ": " + std::to_string(expected) +
                          " rows expected" + (assumed.empty() ? "" : " (" + assumed + ")"));
  Image8 image = decode_image(bytes, input.name(), budget);
  // The decoder may skip chunks before the header, such as Apple's CgBI, and use a later header.
  if (std::uint64_t(image.width) != width || std::uint64_t(image.height) != height)
    input.fail_at(8, "the first chunk of the PNG is not its header");
  return image;
}

ColorMlp read_mlp(const fs::path& folder, const MemoryBudget& budget) {
  Input input = open_in_folder(folder, "mlp_weights.json", budget);
  const nlohmann::json json = read_json(input);
  const auto layer = [&](const char* weights, const char* biases, int inputs, int outputs) {
    const auto count = static_cast<std::size_t>(inputs) * static_cast<std::size_t>(outputs);
    return DenseLayer{
        inputs, outputs,
        json_floats(json_at(json, weights, input.name()), count, input.name(), weights),
        json_floats(json_at(json, biases, input.name()), static_cast<std::size_t>(outputs),
                    input.name(), biases)};
  };
  return {
      .layers = {layer("W1", "b1", 16, 16), layer("W2", "b2", 16, 16), layer("W3", "b3", 16, 3)},
      .encoding = DirectionEncoding::harmonics2,
      .view = ViewConvention::surface_to_eye,
      .blend_channel = 3};
}

/// Implements the rule in diffsoup_export.hpp.
void restore_truncated_half(std::vector<std::uint8_t>& texels, std::vector<Remark>& remarks) {
  constexpr std::size_t channels = LatticeTexture::channels, alpha = LatticeTexture::features;
  std::array<std::size_t, 256> histogram{};
  for (std::size_t i = alpha; i < texels.size(); i += channels) ++histogram[texels[i]];
  if (histogram[127] <= histogram[126] + histogram[128]) return;
  for (std::size_t i = alpha; i < texels.size(); i += channels)
    if (texels[i] == 127) texels[i] = 128;
  remarks.push_back({&remarks::alpha_half_restored,
                     {{"texels", histogram[127]}, {"all", texels.size() / channels}}});
}

}  // namespace

bool is_diffsoup_export(const fs::path& folder) {
  std::error_code ignored;
  return fs::is_regular_file(folder / "mesh.ply", ignored) &&
         fs::is_regular_file(folder / "lut0.png", ignored);
}

std::string foreign_to_diffsoup_export(const fs::path& folder) {
  static constexpr std::array<std::string_view, 5> own{"mesh.ply", "lut0.png", "lut1.png",
                                                       "mlp_weights.json", "meta.json"};
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    std::string name = entry.path().filename().string();
    if (std::find(own.begin(), own.end(), name) == own.end()) return name;
  }
  return {};
}

Scene read_diffsoup_export(const fs::path& folder, const ReadOptions& options) {
  Scene scene;
  const MemoryBudget budget;
  const Meta meta = read_meta(folder, budget, scene.info);
  const fs::path mesh_path = folder / "mesh.ply";
  Input mesh_input = open_in_folder(folder, "mesh.ply", budget);
  DiffSoupMesh mesh = read_diffsoup_mesh(mesh_input);
  const std::size_t faces = mesh.triangles.size();
  expect_count(mesh_path, meta.faces, faces, "faces");
  expect_count(mesh_path, meta.vertices, mesh.positions.size(), "vertices");
  if (faces == 0) throw InputError({mesh_path.string()}, "no faces");
  const std::uint64_t per_face = lattice::texel_count(meta.level);
  const std::uint64_t count = faces * per_face;
  if (count > max_image_pixels)
    throw InputError({mesh_path.string()},
                     std::to_string(count) + " texels are more than an image can have");

  LatticeTexture texture;
  texture.mlp = read_mlp(folder, budget);
  std::vector<std::uint8_t> texels;
  constexpr std::array<const char*, 2> luts{"lut0.png", "lut1.png"};
  for (std::size_t half = 0; half < luts.size(); ++half) {
    if (options.progress) options.progress(0.1 + 0.45 * double(half));
    if (half == 0) mesh_input.take_memory(count, LatticeTexture::channels, "the texels");
    PassingMemory passing(budget);
    const Image8 image = read_lut(folder, luts[half], count, meta.assumed, budget);
    // The memory is allocated only after the first image has confirmed the count of mesh.ply.
    texels.resize(static_cast<std::size_t>(count) * LatticeTexture::channels);
    for (std::size_t i = 0; i < count; ++i)
      std::memcpy(&texels[i * LatticeTexture::channels + 4 * half], &image.pixels[i], 4);
  }
  if (!meta.ours) restore_truncated_half(texels, scene.info.remarks);
  texture.texels = std::move(texels);
  mesh_input.take_memory(faces, sizeof texture.patches[0], "the texels");
  texture.patches.resize(faces);
  for (std::size_t t = 0; t < faces; ++t)
    texture.patches[t] = {static_cast<std::uint32_t>(t * per_face),
                          static_cast<std::uint32_t>(meta.level)};

  scene.layers.push_back({.primitives = TriangleSoup{.positions = std::move(mesh.positions),
                                                     .triangles = std::move(mesh.triangles),
                                                     .appearance = std::move(texture)}});
  scene.info.name = fs::absolute(folder / "").lexically_normal().parent_path().filename().string();
  scene.info.source = "DiffSoup export";
  scene.info.up = meta.up;
  scene.info.background = meta.background;
  if (options.progress) options.progress(1.0);
  return scene;
}

}  // namespace tureen
