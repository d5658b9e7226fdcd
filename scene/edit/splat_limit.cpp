#include "scene/edit/splat_limit.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <numeric>
#include <utility>

#include "scene/edit/splat_edits.hpp"
#include "scene/opaque_windows.hpp"

namespace tureen {

namespace {

/// The product of the two largest.
float largest_area(const glm::vec3& axes) {
  return std::max({axes.x * axes.y, axes.y * axes.z, axes.z * axes.x});
}

}  // namespace

std::vector<float> splat_contributions(const Splats& splats) {
  std::vector<float> result(count(splats));
  for (std::size_t i = 0; i < result.size(); ++i) {
    if (const auto* gaussians = std::get_if<Gaussians>(&splats.kernel)) {
      result[i] = gaussians->opacity[i] * largest_area(gaussians->scales[i]);
    } else if (const auto* windows = std::get_if<TriangleWindows>(&splats.kernel)) {
      const glm::vec3* corner = &windows->corners[3 * i];
      const float area = glm::length(glm::cross(corner[1] - corner[0], corner[2] - corner[0]));
      result[i] = area * static_cast<float>(mean_coverage(windows->opacity[i], windows->sigma[i]));
    } else {
      result[i] = largest_area(std::get<NeuralDensities>(splats.kernel).semi_axes[i]);
    }
  }
  return result;
}

Splats largest_splats(Splats splats, std::size_t max) {
  const std::size_t all = count(splats);
  if (all <= max) return splats;
  const std::vector<float> contributions = splat_contributions(splats);
  std::vector<std::uint32_t> order(all);
  std::iota(order.begin(), order.end(), 0u);
  // Of equal splats the first stay, so that the result does not depend on the library.
  std::nth_element(
      order.begin(), order.begin() + std::ptrdiff_t(max), order.end(),
      [&](std::uint32_t a, std::uint32_t b) {
        return contributions[a] != contributions[b] ? contributions[a] > contributions[b] : a < b;
      });
  std::vector<std::uint8_t> keeps(all, 0);
  for (std::size_t i = 0; i < max; ++i) keeps[order[i]] = 1;
  return keep_splats(std::move(splats), keeps);
}

void limit_splats(Scene& scene, std::uint64_t max) {
  std::uint64_t all = 0, kept = 0;
  for (const Layer& layer : scene.layers)
    if (const auto* splats = std::get_if<Splats>(&layer.primitives)) all += count(*splats);
  if (all <= max) return;
  const double fraction = double(max) / double(all);
  for (Layer& layer : scene.layers) {
    auto* splats = std::get_if<Splats>(&layer.primitives);
    if (!splats || count(*splats) == 0) continue;
    const auto part = static_cast<std::size_t>(fraction * double(count(*splats)));
    *splats = largest_splats(std::move(*splats), std::max<std::size_t>(part, 1));
    kept += count(*splats);
  }
  scene.info.remarks.push_back({Remark::Kind::splats_limited, {kept, all}});
}

}  // namespace tureen
