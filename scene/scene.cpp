#include "scene/scene.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <utility>

#include "base/decimal_text.hpp"
#include "base/error.hpp"
#include "scene/edit/opaque_windows.hpp"
#include "scene/near_limit.hpp"

namespace tureen {

namespace {

std::string layer_names(const Scene& scene) {
  std::string names;
  for (std::size_t i = 0; i < scene.layers.size(); ++i) {
    if (i > 0) names += ", ";
    names += label(scene.layers[i], i);
  }
  return names;
}

bool all_finite(const glm::dmat4& matrix) {
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      if (!std::isfinite(matrix[column][row])) return false;
  return true;
}

}  // namespace

std::string label(const Layer& layer, std::size_t index) {
  return layer.name.empty() ? "layer " + std::to_string(index + 1) : layer.name;
}

void choose_up(SceneInfo& info, const glm::vec3& up) {
  info.up = up;
  info.up_is_assumed = false;
  std::erase_if(info.remarks, [](const Remark& remark) {
    return remark.kind->setting == std::string_view("up");
  });
}

void choose_profile(Scene& scene, std::string_view name) {
  const std::optional<SplatProfile> profile = profile_named(name);
  assert(profile);
  bool found = false;
  for (std::size_t i = 0; i < scene.layers.size(); ++i) {
    auto* splats = std::get_if<Splats>(&scene.layers[i].primitives);
    if (!splats) continue;
    found = true;
    if (const auto reason = profile_defect(splats->kernel, *profile))
      throw UsageError("the profile " + std::string(name) + " does not fit " +
                       label(scene.layers[i], i) + ": " + *reason);
    splats->profile = *profile;
  }
  if (!found)
    throw UsageError("the profile " + std::string(name) + " applies to splats; the scene has none");
  // A profile has a near limit of its own.
  std::erase_if(scene.info.remarks, [](const Remark& remark) {
    const std::string_view setting = remark.kind->setting;
    return setting == "profile" || setting == "near_limit";
  });
  if (const auto remark = near_limit_remark(scene)) scene.info.remarks.push_back(*remark);
}

std::vector<std::string> all_notes(const SceneInfo& info) {
  std::vector<std::string> notes = info.notes;
  for (std::string& sentence : described(info.remarks)) notes.push_back(std::move(sentence));
  return notes;
}

glm::dmat4 at_origin(const glm::dvec3& origin) {
  glm::dmat4 world_from_layer(1.0);
  world_from_layer[3] = glm::dvec4(origin, 1.0);
  return world_from_layer;
}

glm::dvec3 origin_of(const Layer& layer) { return glm::dvec3(layer.world_from_layer[3]); }

Bounds bounds(const Layer& layer) {
  return std::visit([](const auto& primitives) { return bounds(primitives); }, layer.primitives);
}

std::optional<std::string> defect(const Layer& layer) {
  const glm::dmat4& matrix = layer.world_from_layer;
  if (!all_finite(matrix)) return "world_from_layer has a number that is not finite";
  for (int column = 0; column < 4; ++column)
    if (matrix[column][3] != (column == 3 ? 1.0 : 0.0))
      return "the last row of world_from_layer is not 0 0 0 1";

  double largest = 0;
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) largest = std::max(largest, std::abs(matrix[column][row]));
  if (largest == 0) return "the scale of world_from_layer is zero";
  // Elements of at most 1: the squares below neither overflow nor vanish. Division by a subnormal
  // number is exact enough, multiplication by its inverse overflows.
  glm::dmat3 axes(matrix);
  for (int column = 0; column < 3; ++column) axes[column] /= largest;

  // Products of matrices in single precision are below this error. It moves a point by less than
  // 1e-5 of its distance from the layer's origin: 0.01 pixels in an image of 1,000 pixels.
  constexpr double tolerance = 1e-5;
  const glm::dmat3 products = glm::transpose(axes) * axes;
  const double squared_scale = (products[0][0] + products[1][1] + products[2][2]) / 3;
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) {
      const double expected = column == row ? squared_scale : 0.0;
      if (std::abs(products[column][row] - expected) > tolerance * squared_scale)
        return "world_from_layer stretches or shears; only a rotation, a translation, one scale "
               "and a mirror are supported";
    }
  return layer.material ? defect(*layer.material) : std::nullopt;
}

Scene scene_of(Primitives primitives, const glm::dvec3& origin) {
  Scene scene;
  scene.layers.push_back(
      {.world_from_layer = at_origin(origin), .primitives = std::move(primitives)});
  return scene;
}

const Layer& only_layer(const Scene& scene) {
  if (scene.layers.empty())
    throw UsageError("only a scene with one layer is supported here; this scene has no layer");
  if (scene.layers.size() > 1)
    throw UsageError("only a scene with one layer is supported here; this scene has " +
                         std::to_string(scene.layers.size()) + ": " + layer_names(scene),
                     "extract one with tureen convert SCENE --layer NAME -o ONE.glb");
  return scene.layers.front();
}

Layer& only_layer(Scene& scene) {
  return const_cast<Layer&>(only_layer(std::as_const(scene)));  // the scene is not const
}

const TriangleSoup& only_soup(const Scene& scene) {
  return std::get<TriangleSoup>(only_layer(scene).primitives);
}

TriangleSoup& only_soup(Scene& scene) {
  return std::get<TriangleSoup>(only_layer(scene).primitives);
}

Layer& layer_named(Scene& scene, const std::string& name) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < scene.layers.size(); ++i)
    if (label(scene.layers[i], i) == name) found.push_back(i);
  if (found.empty())
    for (std::size_t i = 0; i < scene.layers.size(); ++i)
      if (label({}, i) == name) found.push_back(i);
  if (found.empty() && scene.layers.size() == 1 && name == scene.info.name) return scene.layers[0];
  if (found.size() != 1)
    throw UsageError(
        (found.empty() ? "no layer has the name '" : "several layers have the name '") + name +
        "'; the layers are: " + layer_names(scene));
  return scene.layers[found.front()];
}

void keep_layer(Scene& scene, const std::string& name) {
  Layer kept = std::move(layer_named(scene, name));
  kept.visible = true;
  scene.layers.clear();
  scene.layers.push_back(std::move(kept));
}

std::size_t byte_size(const Scene& scene) {
  std::size_t bytes = 0;
  for (const Layer& layer : scene.layers)
    bytes +=
        std::visit([](const auto& primitives) { return byte_size(primitives); }, layer.primitives);
  return bytes;
}

bool has_visible_layer(const Scene& scene) {
  return std::any_of(scene.layers.begin(), scene.layers.end(),
                     [](const Layer& layer) { return layer.visible; });
}

std::size_t triangle_count(const Scene& scene) {
  std::size_t triangles = 0;
  for (const Layer& layer : scene.layers)
    if (const auto* soup = std::get_if<TriangleSoup>(&layer.primitives))
      triangles += soup->triangles.size();
  return triangles;
}

std::size_t splat_count(const Scene& scene) {
  std::size_t splats = 0;
  for (const Layer& layer : scene.layers)
    if (const auto* of_layer = std::get_if<Splats>(&layer.primitives)) splats += count(*of_layer);
  return splats;
}

std::string primitives_text(std::uint64_t triangles, std::uint64_t splats) {
  if (splats == 0) return counted(triangles, "triangle");
  if (triangles == 0) return counted(splats, "splat");
  return counted(triangles, "triangle") + " and " + counted(splats, "splat");
}

void make_opaque(Scene& scene) {
  for (std::size_t i = 0; i < scene.layers.size(); ++i) {
    Layer& layer = scene.layers[i];
    auto* splats = std::get_if<Splats>(&layer.primitives);
    if (!splats) continue;
    if (!std::holds_alternative<TriangleWindows>(splats->kernel))
      throw UsageError("only triangle windows become opaque triangles; " + label(layer, i) +
                       " holds " + kernel_name(splats->kernel));
    OpaqueResult result = to_opaque(std::move(*splats));
    for (Remark& remark : result.remarks) scene.info.remarks.push_back(std::move(remark));
    layer.primitives = std::move(result.soup);
  }
}

}  // namespace tureen
