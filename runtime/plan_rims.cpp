// What is drawn of cut-out faces: the part that holds all that exists of them.
#include <glm/geometric.hpp>

#include "runtime/face_part.hpp"
#include "runtime/plan_draft.hpp"

namespace tureen {

namespace {

/// A part needs barycentrics of its own, 24 bytes a face more than a whole face does.
constexpr double least_area_saved = 0.05;

double area(const TriangleSoup& soup, std::uint32_t face) {
  const glm::uvec3& t = soup.triangles[face];
  const glm::dvec3 a = soup.positions[t.x], b = soup.positions[t.y], c = soup.positions[t.z];
  return 0.5 * glm::length(glm::cross(b - a, c - a));
}

}  // namespace

void plan_rims(PlanDraft& draft, const LatticeTexture& texture) {
  RenderPlan& plan = draft.plan;
  const TriangleSoup& soup = draft.soup;
  const std::size_t count = plan.faces.size() - plan.opaque_count;
  if (count == 0 || !draft.may(LeaveOut::transparent_rims)) return;
  // Alpha to coverage shows a cut-out up to half a pixel beyond the edge of what exists.
  if (draft.preferences.preset && draft.preferences.preset->alpha_to_coverage > 0) return;
  const std::span<const std::uint32_t> faces(&plan.faces[plan.opaque_count], count);
  std::vector<FacePart> parts(count, whole_face);
  std::size_t smaller = 0;
  double whole_area = 0, part_area = 0;
  for (std::size_t i = 0; i < count; ++i) {
    // Depths of coincident faces must stay bit-identical, that the lower index may win.
    const bool shared = (i > 0 && coincident(soup, faces[i - 1], faces[i])) ||
                        (i + 1 < count && coincident(soup, faces[i], faces[i + 1]));
    if (!shared) parts[i] = existing_part(soup, texture, faces[i]);
    const double share = area_share(parts[i]);
    smaller += share < 1.0 ? 1 : 0;
    whole_area += area(soup, faces[i]);
    part_area += share * area(soup, faces[i]);
  }
  if (!(part_area <= (1.0 - least_area_saved) * whole_area)) return;
  plan.parts = std::move(parts);
  draft.leave_out(
      LeaveOut::transparent_rims,
      formatted("%.0f %% of the area of the cut-out faces, the rims of %zu of %zu where "
                "nothing exists (to the rounding of depth and barycentrics)",
                100.0 * (1.0 - part_area / whole_area), smaller, count));
}

}  // namespace tureen
