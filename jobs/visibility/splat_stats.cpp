#include "jobs/visibility/splat_stats.hpp"

#include <algorithm>

#include "jobs/visibility/splat_use.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen {

SplatStats splat_stats(const Splats& splats, const glm::dmat4& world_from_layer,
                       std::span<const Camera> views, const std::function<void(double)>& progress) {
  SplatStats stats;
  for_each_column(splats.kernel, [&](const auto& column) {
    if (!column.is_absent())
      stats.columns.push_back({column.per_splat == 1 ? plural(column.name) : column.name,
                               column.values.size() * sizeof column.values[0]});
  });
  const std::size_t coefficients = splats.color.coefficients.size(),
                    base = coefficients / std::size_t(harmonics::count(splats.color.degree));
  stats.columns.push_back({"colours", base * sizeof(glm::vec3)});
  if (coefficients > base)
    stats.columns.push_back({"harmonics", (coefficients - base) * sizeof(glm::vec3)});
  if (!splatting::has_layer_for(splats)) return stats;

  const SplatUse use = splat_use(splats, world_from_layer, views, progress);
  stats.views = views.size();
  std::uint64_t pixels = 0, blended = 0;
  for (std::size_t i = 0; i < use.views.size(); ++i) {
    const auto& view = use.views[i];
    if (view.pixels == 0) continue;
    pixels += view.pixels;
    blended += view.blended;
    const double overdraw = double(view.blended) / double(view.pixels);
    if (overdraw <= stats.worst_overdraw) continue;
    stats.worst_overdraw = overdraw;
    stats.worst_view = views[i].name;
  }
  if (pixels > 0) stats.mean_overdraw = double(blended) / double(pixels);
  stats.never_drawn = std::uint64_t(std::count(use.weights.begin(), use.weights.end(), 0u));
  return stats;
}

}  // namespace tureen
