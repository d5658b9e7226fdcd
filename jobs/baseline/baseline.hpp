// The baselines, the references of all claims about speed. And the choice between them and our own
// pipeline, for programs that offer both.
//
// Of soups: our reimplementation of the pipeline in DiffSoup's viewer (arXiv 2603.27151). It has
// the viewer's shortcomings too. It draws only lattice textures with a color MLP, and all faces
// must have the same lattice level. The texels are in lookup textures, which must fit within the
// device's limit for 2D textures. Renderer::read_faces() returns nothing, because its passes store
// no face indices.
//
// Of splats: the plain way that WebGL viewers of Gaussians use (splat_baseline_pass.hpp). It draws
// Gaussians by EWA splatting as the ellipse within sqrt(8) standard deviations, and triangle
// windows as their boxes; windows with a corner behind the near plane are not drawn. It is less
// exact than ours: alpha is not limited, a Gaussian ends where its alpha is still e^-4 of the
// opacity, and each splat is rounded to 8 bits. Renderer::read_splats() returns nothing.
//
// Neither has specialisations.
#pragma once

#include <glm/vec3.hpp>

#include "runtime/gl/context.hpp"
#include "runtime/plan/plan.hpp"
#include "runtime/render_options.hpp"
#include "runtime/renderer.hpp"
#include "scene/scene.hpp"

namespace tureen {

enum class PipelineKind {
  tureen,  // our own: visibility pass, then shading of covered pixels; or forward
  baseline,
};

/// Plans without GL. Of the preferences, only the quality has an effect. The plan's description
/// (describe() in runtime/plan/plan_description.hpp) describes the baseline; if
/// specialisations are switched off, it reports that --keep has no effect. The soup must have no
/// defect(). Throws UsageError for a soup that the baseline cannot draw, for ShadingStage::compute,
/// and for a quality with a defect().
RenderPlan make_baseline_plan(const TriangleSoup& soup, const PlanPreferences& preferences = {});

/// The same for splats. Throws UsageError for discs, neural densities, colours of corners and
/// PlanPreferences::as_published.
RenderPlan make_baseline_plan(const Splats& splats, const PlanPreferences& preferences = {});
RenderPlan make_baseline_plan(const Primitives& primitives,
                              const PlanPreferences& preferences = {});

/// The layer with the baseline's passes. The plan is from make_baseline_plan for its primitives,
/// which must not move until a Renderer was made. The Renderer throws DeviceLimitError if the
/// lookup textures of a soup exceed `limits`.
PreparedScene prepare_baseline(const PlacedLayer& layer, const DeviceLimits& limits,
                               RenderPlan plan);

/// Plans and uploads for this pipeline. Throws as prepare_scene, make_baseline_plan and Renderer.
Renderer make_renderer(const gl::Context& context, const TriangleSoup& soup, glm::dvec3 origin,
                       PipelineKind kind, const RenderOptions& options = {});
/// The same for a scene. Throws as only_layer for the baseline, which draws one layer.
Renderer make_renderer(const gl::Context& context, const Scene& scene, PipelineKind kind,
                       const RenderOptions& options = {});

}  // namespace tureen
