#include "formats/torch/checkpoint.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "formats/common/format_remarks.hpp"
#include "formats/common/splat_activation.hpp"
#include "formats/torch/checkpoint_remarks.hpp"
#include "formats/torch/torch_archive.hpp"
#include "scene/edit/morton_order.hpp"
#include "scene/edit/splat_edits.hpp"
#include "scene/lattice.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen {

namespace {

constexpr glm::vec3 colmap_up{0.0f, -1.0f, 0.0f};

/// Indices and counts are 32 bits wide in a soup.
void expect_at_most(const TorchArchive& archive, std::uint64_t count, const char* what) {
  if (count > std::numeric_limits<std::uint32_t>::max())
    archive.fail(std::to_string(count) + " " + what + " are more than 32 bits can count");
}

/// All elements of a tensor, three a vector.
std::vector<glm::vec3> read_vectors(TorchArchive& archive, const TorchTensor& tensor) {
  PassingMemory passing(archive.budget());
  const std::vector<float> values = archive.read_floats(tensor);
  archive.take_memory(tensor, values.size(), sizeof values[0]);
  std::vector<glm::vec3> vectors(values.size() / 3);
  if (!vectors.empty())
    std::memcpy(vectors.data(), values.data(), vectors.size() * sizeof vectors[0]);
  passing.keep(values.size() * sizeof values[0]);
  return vectors;
}

/// Triangles from an [F,3] tensor of indices, each checked against the vertices.
std::vector<glm::uvec3> read_triangles(TorchArchive& archive, std::string_view key,
                                       std::size_t vertices) {
  const TorchTensor tensor = archive.tensor(key);
  archive.expect_shape(tensor, {any_size, 3});
  PassingMemory passing(archive.budget());
  const auto indices = archive.read_integers(tensor);
  archive.take_memory(tensor, indices.size(), sizeof(std::uint32_t));
  passing.keep(indices.size() * sizeof(std::uint32_t));
  std::vector<glm::uvec3> triangles(indices.size() / 3);
  for (std::size_t i = 0; i < indices.size(); ++i) {
    if (indices[i] < 0 || static_cast<std::uint64_t>(indices[i]) >= vertices)
      archive.fail("\"" + std::string(key) + "\": face " + std::to_string(i / 3) +
                   " names vertex " + std::to_string(indices[i]) + " of " +
                   std::to_string(vertices));
    triangles[i / 3][static_cast<int>(i % 3)] = static_cast<std::uint32_t>(indices[i]);
  }
  return triangles;
}

// ---- DiffSoup

DenseLayer read_layer(TorchArchive& archive, const Pickle::Value& state, const std::string& prefix,
                      int inputs, int outputs) {
  const auto read = [&](const char* suffix, const std::vector<std::uint64_t>& shape) {
    const std::string key = prefix + suffix;
    const Pickle::Value* value = archive.pickle().find(state, key);
    if (!value) archive.fail("\"color_mlp\" has no \"" + key + "\"");
    const TorchTensor tensor = archive.tensor(*value, key);
    archive.expect_shape(tensor, shape);
    return archive.read_floats(tensor);
  };
  const auto wide = static_cast<std::uint64_t>(inputs), high = static_cast<std::uint64_t>(outputs);
  return {.inputs = inputs,
          .outputs = outputs,
          .weights = read(".weight", {high, wide}),
          .biases = read(".bias", {high})};
}

/// The 16-16-16-3 network. Its inputs are seven features and the nine harmonics of degree 2.
ColorMlp read_color_mlp(TorchArchive& archive) {
  const Pickle::Value& state = archive.at("color_mlp");
  ColorMlp mlp{.layers = {},
               .encoding = DirectionEncoding::harmonics2,
               .view = ViewConvention::surface_to_eye,
               .blend_channel = 3};
  mlp.layers.push_back(read_layer(archive, state, "mlp.0", 16, 16));
  mlp.layers.push_back(read_layer(archive, state, "mlp.2", 16, 16));
  mlp.layers.push_back(read_layer(archive, state, "mlp.4", 16, 3));
  if (const auto why = defect(mlp, LatticeTexture::features)) archive.fail(*why);
  return mlp;
}

/// The level whose lattice has this many texels, or nullopt.
std::optional<int> level_of(std::uint64_t texels) {
  for (int level = 0; level <= lattice::max_level; ++level)
    if (lattice::texel_count(level) == texels) return level;
  return std::nullopt;
}

/// Copies `from`, `count` values a texel, into the channels from `first` on.
void spread(TorchArchive& archive, const TorchTensor& from, std::size_t count, std::size_t first,
            std::vector<float>& texels) {
  PassingMemory passing(archive.budget());
  const std::vector<float> values = archive.read_floats(from);
  for (std::size_t i = 0; i < values.size(); ++i) {
    // Negated so that NaN is rejected, too.
    if (!(values[i] >= 0.0f && values[i] <= 1.0f))
      archive.fail("\"" + from.name + "\" holds " + std::to_string(values[i]) + " for texel " +
                   std::to_string(i / count) + ", outside 0..1");
    texels[i / count * LatticeTexture::channels + first + i % count] = values[i];
  }
}

Scene read_diffsoup(TorchArchive& archive, const ReadOptions& options) {
  const TorchTensor vertices = archive.tensor("V");
  archive.expect_shape(vertices, {any_size, 3});
  const TorchTensor features = archive.tensor("feat_acc");
  archive.expect_shape(features, {any_size, any_size, LatticeTexture::features});
  const std::uint64_t faces = features.shape[0], per_face = features.shape[1];
  const TorchTensor alpha = archive.tensor("alpha_acc");
  archive.expect_shape(alpha, {faces, per_face, 1});
  const auto level = level_of(per_face);
  if (!level)
    archive.fail("\"feat_acc\" has " + std::to_string(per_face) +
                 " texels a face, which no lattice level from 0 to 7 has");
  if (archive.find("Rmax") && archive.integer("Rmax") != *level)
    archive.fail("\"Rmax\" is " + std::to_string(archive.integer("Rmax")) + ", but " +
                 std::to_string(per_face) + " texels a face are level " + std::to_string(*level));
  expect_at_most(archive, vertices.shape[0], "vertices");
  expect_at_most(archive, faces * per_face, "texels");

  TriangleSoup soup;
  soup.positions = read_vectors(archive, vertices);
  soup.triangles = read_triangles(archive, "F", soup.positions.size());
  if (soup.triangles.size() != faces)
    archive.fail("\"F\" has " + std::to_string(soup.triangles.size()) + " faces, \"feat_acc\" " +
                 std::to_string(faces));

  LatticeTexture texture;
  texture.mlp = read_color_mlp(archive);
  archive.take_memory(features, faces, sizeof texture.patches[0]);
  texture.patches.resize(soup.triangles.size());
  for (std::size_t t = 0; t < texture.patches.size(); ++t)
    texture.patches[t] = {static_cast<std::uint32_t>(t * per_face),
                          static_cast<std::uint32_t>(*level)};
  archive.take_memory(features, faces * per_face, LatticeTexture::channels * sizeof(float));
  std::vector<float> texels(static_cast<std::size_t>(faces * per_face) * LatticeTexture::channels);
  if (options.progress) options.progress(0.1);
  spread(archive, features, LatticeTexture::features, 0, texels);
  if (options.progress) options.progress(0.9);
  spread(archive, alpha, 1, LatticeTexture::features, texels);
  texture.texels = std::move(texels);
  soup.appearance = std::move(texture);

  Scene scene = scene_of(std::move(soup));
  scene.info.source = "DiffSoup checkpoint";
  // Only the Mip-NeRF 360 script, which trains in COLMAP's axes on black, saves this key.
  const bool colmap = archive.find("flip_z") != nullptr;
  scene.info.up = colmap ? colmap_up : glm::vec3(0.0f, 0.0f, 1.0f);
  scene.info.background = glm::vec3(colmap ? 0.0f : 1.0f);
  scene.info.remarks.push_back(
      {colmap ? &remarks::up_of_colmap_scene : &remarks::up_of_synthetic_scene});
  return scene;
}

// ---- Triangle Splatting and its followers

struct HarmonicsOf {
  int degree = 0;
  std::vector<glm::vec3> coefficients;
};

/// The constant coefficient and the rest, interleaved element by element up to the active degree.
HarmonicsOf read_harmonics(TorchArchive& archive, std::uint64_t elements) {
  const std::int64_t degree = archive.integer("active_sh_degree");
  if (degree < 0 || degree > harmonics::max_degree)
    archive.fail("\"active_sh_degree\" is " + std::to_string(degree) + ", outside 0..4");
  const TorchTensor constant = archive.tensor("features_dc");
  archive.expect_shape(constant, {elements, 1, 3});
  HarmonicsOf result{static_cast<int>(degree), {}};
  const auto count = static_cast<std::size_t>(harmonics::count(result.degree));
  if (count == 1) {
    result.coefficients = read_vectors(archive, constant);
    return result;
  }
  const TorchTensor others = archive.tensor("features_rest");
  archive.expect_shape(others, {elements, any_size, 3});
  const auto stored = static_cast<std::size_t>(others.shape[1]);
  if (stored + 1 < count)
    archive.fail("\"features_rest\" has " + std::to_string(stored) +
                 " coefficients, harmonics of degree " + std::to_string(degree) + " need " +
                 std::to_string(count - 1));
  archive.take_memory(others, elements, count * sizeof result.coefficients[0]);
  PassingMemory passing(archive.budget());
  const std::vector<float> first = archive.read_floats(constant);
  const std::vector<float> rest = archive.read_floats(others);
  result.coefficients.resize(static_cast<std::size_t>(elements) * count);
  for (std::size_t e = 0; e < elements; ++e) {
    glm::vec3* out = &result.coefficients[e * count];
    std::memcpy(out, &first[e * 3], sizeof *out);
    std::memcpy(out + 1, &rest[e * stored * 3], (count - 1) * sizeof *out);
  }
  return result;
}

/// The scene of the valid windows, in Morton order. `origin`: of errors about memory.
Scene scene_of_windows(TorchArchive& archive, const TorchTensor& origin, const ReadOptions& options,
                       Splats splats) {
  const std::size_t all = count(splats);
  std::vector<std::uint8_t> keeps(all);
  for (std::size_t i = 0; i < all; ++i) keeps[i] = is_valid(splats, i);
  if (options.keep_rows) {
    archive.take_memory(origin, all, sizeof splats.rows[0]);
    number_rows(splats);
  }
  splats = keep_splats(std::move(splats), keeps);
  const std::size_t kept = count(splats);
  {
    PassingMemory passing(archive.budget());
    archive.take_memory(origin, morton_order_bytes(splats), 1);
    sort_in_morton_order(splats);
  }
  Scene scene = scene_of(std::move(splats));
  if (kept < all)
    scene.info.remarks.push_back(
        {&remarks::splats_dropped, {{"dropped", all - kept}, {"all", all}}});
  scene.info.up = colmap_up;
  scene.info.up_is_assumed = true;
  scene.info.remarks.push_back({&remarks::up_unknown_to_checkpoint});
  return scene;
}

Scene read_triangle_splatting(TorchArchive& archive, const ReadOptions& options) {
  const TorchTensor points = archive.tensor("triangles_points");
  archive.expect_shape(points, {any_size, 3, 3});
  const std::uint64_t count = points.shape[0];
  expect_at_most(archive, count * 3, "vertices");
  const TorchTensor sigma = archive.tensor("sigma"), opacity = archive.tensor("opacity");
  archive.expect_shape(sigma, {count, 1});
  archive.expect_shape(opacity, {count, 1});

  Splats splats;
  splats.profile = *profile_named("triangle-splatting");
  auto& windows = splats.kernel.emplace<TriangleWindows>();
  windows.corners = read_vectors(archive, points);
  windows.sigma = archive.read_floats(sigma);
  windows.opacity = archive.read_floats(opacity);
  for (float& s : windows.sigma) s = static_cast<float>(0.01 + std::exp(double(s)));
  for (float& o : windows.opacity) o = static_cast<float>(sigmoid(double(o)));
  if (options.progress) options.progress(0.3);
  HarmonicsOf sh = read_harmonics(archive, count);

  splats.color.degree = sh.degree;
  splats.color.coefficients = std::move(sh.coefficients);
  Scene scene = scene_of_windows(archive, points, options, std::move(splats));
  scene.info.source = "Triangle Splatting checkpoint";
  return scene;
}

/// The `each` values of every corner, from those of the vertices.
std::vector<glm::vec3> at_corners(TorchArchive& archive, const TorchTensor& origin,
                                  const std::vector<glm::vec3>& of_vertices, std::size_t each,
                                  const std::vector<glm::uvec3>& triangles) {
  archive.take_memory(origin, 3 * triangles.size(), each * sizeof of_vertices[0]);
  std::vector<glm::vec3> result;
  result.reserve(3 * each * triangles.size());
  for (const glm::uvec3& triangle : triangles)
    for (int k = 0; k < 3; ++k) {
      const auto first = of_vertices.begin() + std::ptrdiff_t(each * triangle[k]);
      result.insert(result.end(), first, first + std::ptrdiff_t(each));
    }
  return result;
}

/// The opacity of a triangle is the least of its vertices': floor + (1 - floor) sigmoid(weight).
std::vector<float> least_opacity(TorchArchive& archive, std::uint64_t vertices, double floor,
                                 const std::vector<glm::uvec3>& triangles) {
  const TorchTensor tensor = archive.tensor("vertex_weight");
  archive.expect_shape(tensor, {vertices, 1});
  archive.take_memory(tensor, triangles.size(), sizeof(float));
  PassingMemory passing(archive.budget());
  const std::vector<float> weights = archive.read_floats(tensor);
  std::vector<float> opacity;
  opacity.reserve(triangles.size());
  for (const glm::uvec3& triangle : triangles) {
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
      const double weight = weights[triangle[k]];
      // NaN stays: std::min returns its first argument unless the second is less.
      least = std::isnan(weight) ? weight : std::min(least, weight);
    }
    opacity.push_back(static_cast<float>(floor + (1.0 - floor) * sigmoid(least)));
  }
  return opacity;
}

Scene read_connected_triangles(TorchArchive& archive, const ReadOptions& options) {
  // MeshSplatting saves the same keys as Triangle Splatting+, plus a pixel count.
  const bool mesh_splatting = archive.find("pixel_count") != nullptr;
  // Neither saves the floor of the opacity; these are the values that their own readers set.
  const double opacity_floor = mesh_splatting ? 0.999 : 0.9999;
  const TorchTensor points = archive.tensor("triangles_points");
  archive.expect_shape(points, {any_size, 3});
  expect_at_most(archive, points.shape[0], "vertices");
  const auto sigma = static_cast<float>(std::exp(archive.number("sigma")));
  if (!(sigma > 0 && std::isfinite(sigma)))
    archive.fail("\"sigma\" is " + std::to_string(archive.number("sigma")) +
                 ", the logarithm of a number that is not positive and finite");

  Splats splats;
  splats.profile = *profile_named(mesh_splatting ? "mesh-splatting" : "triangle-splatting");
  auto& windows = splats.kernel.emplace<TriangleWindows>();
  SplatColor& color = splats.color;
  color.per_corner = true;
  {
    PassingMemory passing(archive.budget());
    const std::vector<glm::vec3> vertices = read_vectors(archive, points);
    const auto triangles = read_triangles(archive, "_triangle_indices", vertices.size());
    expect_at_most(archive, 3 * triangles.size(), "corners");
    windows.corners = at_corners(archive, points, vertices, 1, triangles);
    archive.take_memory(points, triangles.size(), sizeof sigma);
    windows.sigma.assign(triangles.size(), sigma);
    windows.opacity = least_opacity(archive, vertices.size(), opacity_floor, triangles);
    if (options.progress) options.progress(0.3);
    const HarmonicsOf sh = read_harmonics(archive, vertices.size());
    color.degree = sh.degree;
    color.coefficients = at_corners(archive, archive.tensor("features_dc"), sh.coefficients,
                                    std::size_t(harmonics::count(sh.degree)), triangles);
    passing.keep(triangles.size() * (3 * sizeof(glm::vec3) + 2 * sizeof(float) +
                                     coefficients_per_splat(color) * sizeof color.coefficients[0]));
  }
  Scene scene = scene_of_windows(archive, points, options, std::move(splats));
  scene.info.source =
      mesh_splatting ? "MeshSplatting checkpoint" : "Triangle Splatting+ checkpoint";
  return scene;
}

}  // namespace

bool is_checkpoint(std::span<const std::byte> head) {
  constexpr std::array<unsigned char, 4> zip{'P', 'K', 3, 4};
  // A pickle of a magic number: PROTO 2, LONG1 of ten bytes, 0x1950a86a20f9469cfc6c.
  constexpr std::array<unsigned char, 6> old{0x80, 2, 0x8a, 10, 0x6c, 0xfc};
  const auto begins_with = [&](const auto& magic) {
    return head.size() >= magic.size() && std::memcmp(head.data(), magic.data(), magic.size()) == 0;
  };
  return begins_with(zip) || begins_with(old);
}

Scene read_checkpoint(const std::filesystem::path& path, const ReadOptions& options) {
  Scene scene = read_checkpoint(Input::open(path), options);
  scene.info.name = path.stem().string();
  return scene;
}

Scene read_checkpoint(Input input, const ReadOptions& options) {
  TorchArchive archive(std::move(input));
  const auto has = [&](const char* key) { return archive.find(key) != nullptr; };
  Scene scene;
  if (has("feat_acc"))
    scene = read_diffsoup(archive, options);
  else if (has("triangles_points") && has("_triangle_indices"))
    scene = read_connected_triangles(archive, options);
  else if (has("triangles_points"))
    scene = read_triangle_splatting(archive, options);
  else
    archive.fail(
        "an unsupported torch file: neither \"feat_acc\" (DiffSoup) nor \"triangles_points\" "
        "(Triangle Splatting) is among its keys");
  if (options.progress) options.progress(1.0);
  return scene;
}

}  // namespace tureen
