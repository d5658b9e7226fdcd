#include "scene/opaque_windows.hpp"

#include "scene/edit/splat_edits.hpp"
#include "scene/scene_remarks.hpp"

namespace tureen {

OpaqueResult to_opaque(Splats splats, float minimum_opacity) {
  const std::size_t count = tureen::count(splats);
  {
    const auto& opacity = std::get<TriangleWindows>(splats.kernel).opacity;
    std::vector<std::uint8_t> keeps(count);
    for (std::size_t t = 0; t < count; ++t) keeps[t] = opacity[t] >= minimum_opacity;
    splats = keep_splats(std::move(splats), keeps);
  }
  auto& windows = std::get<TriangleWindows>(splats.kernel);
  SplatColor& color = splats.color;
  const std::size_t kept = windows.opacity.size();
  double coverage = 0, mean_opacity = 0;
  for (std::size_t t = 0; t < kept; ++t) {
    coverage += mean_coverage(windows.opacity[t], windows.sigma[t]);
    mean_opacity += windows.opacity[t];
  }

  OpaqueResult result;
  result.soup.positions = std::move(windows.corners);
  result.soup.triangles.resize(kept);
  for (std::size_t t = 0; t < kept; ++t)
    result.soup.triangles[t] = glm::uvec3(3 * t, 3 * t + 1, 3 * t + 2);
  result.soup.appearance =
      Harmonics{.domain = color.per_corner ? Harmonics::Domain::vertex : Harmonics::Domain::face,
                .degree = color.degree,
                .view = ViewConvention::eye_to_surface,
                .coefficients = std::move(color.coefficients)};
  if (count == 0) return result;

  if (kept > 0)
    result.remarks.push_back(
        {&remarks::soft_triangles_opaque,
         {{"coverage", coverage / double(kept)}, {"opacity", mean_opacity / double(kept)}}});
  if (kept > 0 && color.per_corner)
    result.remarks.push_back({&remarks::screen_interpolation_dropped});
  if (kept < count)
    result.remarks.push_back({&remarks::soft_triangles_dropped,
                              {{"dropped", count - kept},
                               {"all", count},
                               {"smallest_opacity", double(minimum_opacity)}}});
  return result;
}

}  // namespace tureen
