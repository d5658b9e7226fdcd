#include "scene/edit/opaque_windows.hpp"

#include "scene/edit/splat_edits.hpp"
#include "scene/scene_remarks.hpp"

namespace tureen {

TriangleSoup hard_shapes(std::vector<glm::vec3> corners, SplatColor color) {
  std::vector<glm::uvec3> triangles = unshared_triangles(corners.size() / 3);
  return {.positions = std::move(corners),
          .triangles = std::move(triangles),
          .appearance = Harmonics{
              .domain = color.per_corner ? Harmonics::Domain::vertex : Harmonics::Domain::face,
              .degree = color.degree,
              .view = ViewConvention::eye_to_surface,
              .coefficients = std::move(color.coefficients)}};
}

OpaqueResult to_opaque(Splats splats, float minimum_opacity) {
  const std::size_t count = tureen::count(splats);
  {
    const auto& opacity = std::get<TriangleWindows>(splats.kernel).opacity;
    std::vector<std::uint8_t> keeps(count);
    for (std::size_t t = 0; t < count; ++t) keeps[t] = opacity[t] >= minimum_opacity;
    splats = keep_splats(std::move(splats), keeps);
  }
  auto& windows = std::get<TriangleWindows>(splats.kernel);
  const std::size_t kept = windows.opacity.size();
  double coverage = 0, mean_opacity = 0;
  for (std::size_t t = 0; t < kept; ++t) {
    coverage += mean_coverage(windows.opacity[t], windows.sigma[t]);
    mean_opacity += windows.opacity[t];
  }

  OpaqueResult result;
  const bool per_corner = splats.color.per_corner;
  result.soup = hard_shapes(std::move(windows.corners), std::move(splats.color));
  if (count == 0) return result;

  if (kept > 0)
    result.remarks.push_back(
        {&remarks::soft_triangles_opaque,
         {{"coverage", coverage / double(kept)}, {"opacity", mean_opacity / double(kept)}}});
  if (kept > 0 && per_corner) result.remarks.push_back({&remarks::screen_interpolation_dropped});
  if (kept < count)
    result.remarks.push_back({&remarks::soft_triangles_dropped,
                              {{"dropped", count - kept},
                               {"all", count},
                               {"smallest_opacity", double(minimum_opacity)}}});
  return result;
}

}  // namespace tureen
