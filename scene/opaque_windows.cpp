#include "scene/opaque_windows.hpp"

#include "scene/scene_remarks.hpp"

namespace tureen {

double mean_coverage(double opacity, double sigma) {
  return opacity * 2.0 / ((sigma + 1.0) * (sigma + 2.0));
}

OpaqueResult to_opaque(Splats splats, float minimum_opacity) {
  auto& windows = std::get<TriangleWindows>(splats.kernel);
  SplatColor& color = splats.color;
  const std::size_t count = windows.sigma.size();
  double coverage = 0, mean_opacity = 0;
  const std::size_t kept = keep_windows(splats, [&](std::size_t t) {
    // Negated, so that a NaN opacity is dropped too.
    if (!(windows.opacity[t] >= minimum_opacity)) return false;
    coverage += mean_coverage(windows.opacity[t], windows.sigma[t]);
    mean_opacity += windows.opacity[t];
    return true;
  });

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
