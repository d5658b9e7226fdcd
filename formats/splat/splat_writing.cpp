#include "formats/splat/splat_writing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <utility>

#include "base/decimal_text.hpp"
#include "base/error.hpp"
#include "scene/edit/baked_transform.hpp"
#include "scene/edit/moved_splats.hpp"
#include "scene/similarity.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen {

void place_in_world(Layer& layer) {
  constexpr double farthest = 128;  // in radii of the layer
  bake_transform(layer);
  const Bounds box = bounds(layer);
  if (glm::length(origin_of(layer)) > farthest * box.radius()) return;
  move_splats(std::get<Splats>(layer.primitives), layer.world_from_layer);
  layer.world_from_layer = glm::dmat4(1.0);
}

std::vector<std::string> profile_losses(SplatProfile profile, const std::string& format,
                                        std::string_view stored) {
  const SplatProfile found = *profile_named(stored);
  std::vector<std::string> lost;
  if (profile.min_center_depth != found.min_center_depth)
    lost.push_back(format + " holds no near limit; readers use " +
                   short_decimal(double(found.min_center_depth), 6) + ".");
  profile.min_center_depth = found.min_center_depth;
  if (profile != found)
    lost.push_back(format + " cannot hold this profile; readers use " + std::string(stored) + ".");
  return lost;
}

std::vector<std::string> splat_losses(const Scene& scene, const Layer& layer,
                                      const std::string& format, std::string_view stored) {
  std::vector<std::string> lost =
      profile_losses(std::get<Splats>(layer.primitives).profile, format, stored);
  if (layer.world_from_layer != glm::dmat4(1.0))
    lost.push_back(format + " holds no origin: the splats are written relative to it.");
  if (scene.info.up != splat_up)
    lost.push_back(format + " stores no up axis: readers assume -y, but that of the scene is " +
                   axis_name(glm::dvec3(scene.info.up)) + ", so they show it tilted.");
  if (scene.info.background != glm::vec3(0.0f))
    lost.push_back(format + " holds no background colour.");
  if (!scene.cameras.empty()) lost.push_back(format + " holds no cameras.");
  if (scene.first_view) lost.push_back(format + " holds no first view.");
  return lost;
}

bool holds_gaussians(const Scene& scene) {
  if (scene.layers.size() != 1) return false;
  const auto* splats = std::get_if<Splats>(&scene.layers[0].primitives);
  return splats && std::holds_alternative<Gaussians>(splats->kernel);
}

StoredGaussians gaussians_for(const Scene& scene, const GaussianFormat& format) {
  Layer layer = only_layer(scene);
  auto* splats = std::get_if<Splats>(&layer.primitives);
  if (!splats || !std::holds_alternative<Gaussians>(splats->kernel))
    throw UsageError(format.name + " holds only Gaussians, and this scene has " +
                         (splats ? kernel_name(splats->kernel) : "triangles"),
                     "write .glb");
  if (layer.world_from_layer != glm::dmat4(1.0)) place_in_world(layer);
  auto& gaussians = std::get<Gaussians>(splats->kernel);
  const SplatProfile& profile = splats->profile;
  StoredGaussians stored;
  stored.profile = "3dgs";
  if (gaussians.flat && format.has_flat)
    stored.profile = format.flat_profile;
  else if (format.has_mip && profile.low_pass == SplatProfile::LowPass::mip)
    stored.profile = "mip";
  stored.lost = splat_losses(scene, layer, format.name, stored.profile);
  if (gaussians.flat && !format.has_flat)
    stored.lost.push_back(format.name +
                          " holds no discs: they are written as ellipsoids without thickness.");
  if (gaussians.flat)
    for (glm::vec3& scales : gaussians.scales) scales.z = 0;
  SplatColor& color = splats->color;
  if (color.degree > format.max_degree) {
    if (degree_in_use(color) > format.max_degree)
      stored.lost.push_back(format.name + " holds harmonics up to degree " +
                            std::to_string(format.max_degree) + "; higher ones are dropped.");
    const std::size_t each = harmonics::count(color.degree),
                      kept = harmonics::count(format.max_degree);
    for (std::size_t i = 0; i < gaussians.centers.size(); ++i)
      std::copy_n(color.coefficients.begin() + std::ptrdiff_t(i * each), kept,
                  color.coefficients.begin() + std::ptrdiff_t(i * kept));
    color.coefficients.resize(gaussians.centers.size() * kept);
    color.degree = format.max_degree;
  }
  stored.splats = std::move(*splats);
  return stored;
}

void order_axes(glm::vec3& scales, glm::quat& rotation, bool flat) {
  std::array<int, 3> order{0, 1, 2};
  std::stable_sort(order.begin(), order.begin() + (flat ? 2 : 3),
                   [&](int a, int b) { return scales[a] > scales[b]; });
  const glm::dmat3 axes = glm::mat3_cast(glm::dquat(rotation));
  glm::dmat3 turned(axes[order[0]], axes[order[1]], axes[order[2]]);
  // A mirrored ellipsoid is the same one.
  if (glm::determinant(turned) < 0) turned[2] = -turned[2];
  scales = glm::vec3(scales[order[0]], scales[order[1]], scales[order[2]]);
  glm::dquat q = glm::normalize(glm::quat_cast(turned));
  // Half turns about the axes change nothing but the place of the largest part.
  const std::array<double, 4> sizes{std::abs(q.w), std::abs(q.x), std::abs(q.y), std::abs(q.z)};
  const auto largest = std::max_element(sizes.begin(), sizes.end()) - sizes.begin();
  if (largest == 1) q = q * glm::dquat(0, 1, 0, 0);
  if (largest == 2) q = q * glm::dquat(0, 0, 1, 0);
  if (largest == 3) q = q * glm::dquat(0, 0, 0, 1);
  rotation = glm::quat(q.w < 0 ? -q : q);
}

}  // namespace tureen
