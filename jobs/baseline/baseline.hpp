// The baseline: our reimplementation of the pipeline in DiffSoup's viewer (arXiv 2603.27151), the
// reference of all claims about speed. And the choice between the baseline and our own pipeline,
// for programs that offer both.
//
// The baseline has the viewer's shortcomings too. It draws only lattice textures with a color
// MLP, and all faces must have the same lattice level. The texels are in lookup textures, which
// must fit within the device's limit for 2D textures. It has no specialisations.
// Renderer::read_faces() returns nothing, because its passes store no face indices.
#pragma once

#include <glm/vec3.hpp>

#include "runtime/gl/context.hpp"
#include "runtime/plan/plan.hpp"
#include "runtime/render_options.hpp"
#include "runtime/renderer.hpp"
#include "scene/triangle_soup.hpp"

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

/// The soup with the baseline's passes. The plan is from make_baseline_plan for this soup, which
/// must not move until a Renderer was made. The Renderer throws DeviceLimitError if the lookup
/// textures exceed `limits`.
PreparedScene prepare_baseline(const PlacedSoup& layer, const DeviceLimits& limits,
                               RenderPlan plan);

/// Plans and uploads for this pipeline. Throws as prepare_scene, make_baseline_plan and Renderer.
Renderer make_renderer(const gl::Context& context, const TriangleSoup& soup, glm::dvec3 origin,
                       PipelineKind kind, const RenderOptions& options = {});
/// The same for a scene of soups. Throws as only_layer for the baseline, which draws one layer.
Renderer make_renderer(const gl::Context& context, const Scene& scene, PipelineKind kind,
                       const RenderOptions& options = {});

}  // namespace tureen
