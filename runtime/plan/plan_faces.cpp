// The geometry's part of a plan: the drawn faces, their buckets and their order.
#include <algorithm>

#include "runtime/plan/face_alpha.hpp"
#include "runtime/plan/plan_draft.hpp"

namespace tureen {

namespace {

std::vector<std::uint32_t> drawable_faces(PlanDraft& draft) {
  std::vector<std::uint32_t> faces;
  for (std::uint32_t t = 0; t < draft.soup.triangles.size(); ++t)
    if (drawable(draft.soup, t)) faces.push_back(t);
  draft.plan.undrawable_faces = draft.soup.triangles.size() - faces.size();
  return faces;
}

/// Of coincident faces, the lowest index wins wherever it is opaque. Faces behind a fully opaque
/// one are therefore never visible. `faces`: sorted spatially.
void skip_coincident_faces(PlanDraft& draft, const std::vector<FaceAlpha>& alpha,
                           std::vector<std::uint32_t>& faces) {
  std::vector<std::uint32_t> kept;
  kept.reserve(faces.size());
  for (const std::uint32_t face : faces)
    if (kept.empty() || alpha[kept.back()] != FaceAlpha::opaque ||
        !coincident(draft.soup, kept.back(), face))
      kept.push_back(face);
  if (kept.size() == faces.size()) return;
  draft.apply({Specialisation::coincident_faces, faces.size() - kept.size(), faces.size()});
  faces = std::move(kept);
}

/// Of coincident faces, the lower index must win, so opaque and cut-out ones are drawn in one
/// bucket. `faces`: sorted spatially.
void draw_coincident_faces_alike(const TriangleSoup& soup, std::span<const std::uint32_t> faces,
                                 std::vector<FaceAlpha>& alpha) {
  for (std::size_t i = 0; i < faces.size();) {
    std::size_t end = i + 1;
    bool mixed = false;
    for (; end < faces.size() && coincident(soup, faces[i], faces[end]); ++end)
      mixed = mixed || alpha[faces[end]] != alpha[faces[i]];
    for (std::size_t k = i; mixed && k < end; ++k) alpha[faces[k]] = FaceAlpha::cut_out;
    i = end;
  }
}

/// Software renderers draw fewer faces than this in a few milliseconds.
constexpr std::size_t min_culled_faces = 16384;

void plan_small_triangles(PlanDraft& draft, const DeviceLimits& limits) {
  if (!limits.software || draft.plan.faces.size() < min_culled_faces ||
      !draft.may(Specialisation::small_triangles))
    return;
  draft.plan.drops_small_triangles = true;
  draft.apply({Specialisation::small_triangles});
}

}  // namespace

void plan_faces(PlanDraft& draft, const DeviceLimits& limits) {
  const TriangleSoup& soup = draft.soup;
  SoupPlan& plan = draft.plan;
  std::vector<std::uint32_t> faces = drawable_faces(draft);

  std::vector<FaceAlpha> alpha(soup.triangles.size(), FaceAlpha::cut_out);
  if (draft.preferences.specialise) alpha = classify_alpha(soup);
  if (draft.may(Specialisation::transparent_faces)) {
    const std::size_t before = faces.size();
    std::erase_if(faces, [&](std::uint32_t t) { return alpha[t] == FaceAlpha::transparent; });
    if (faces.size() < before)
      draft.apply({Specialisation::transparent_faces, before - faces.size(), before});
  }

  sort_spatially(soup, faces);
  if (draft.may(Specialisation::coincident_faces)) skip_coincident_faces(draft, alpha, faces);
  if (!draft.may(Specialisation::alpha_test))
    std::fill(alpha.begin(), alpha.end(), FaceAlpha::cut_out);
  draw_coincident_faces_alike(soup, faces, alpha);
  const auto first_cut_out = std::stable_partition(
      faces.begin(), faces.end(), [&](std::uint32_t t) { return alpha[t] == FaceAlpha::opaque; });
  plan.opaque_count = std::size_t(first_cut_out - faces.begin());
  plan.faces = std::move(faces);
  if (plan.opaque_count > 0)
    draft.apply({Specialisation::alpha_test, plan.opaque_count, plan.faces.size()});

  const auto opaque = std::uint32_t(plan.opaque_count), all = std::uint32_t(plan.faces.size());
  const std::uint32_t size = cluster_size(plan.faces.size());
  append_clusters(soup, plan.faces, 0, opaque, size, plan.clusters);
  append_clusters(soup, plan.faces, opaque, all, size, plan.clusters);
  plan_small_triangles(draft, limits);
}

}  // namespace tureen
