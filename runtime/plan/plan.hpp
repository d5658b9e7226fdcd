// The plan: how a scene is drawn on a device, and which specialisations apply. Made once, without
// GL; the pipelines draw by it. plan_description.hpp puts it into English. A test holds each
// specialisation against the plan made with `specialise = false`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "runtime/plan/color_mlp_source.hpp"
#include "runtime/plan/draw_order.hpp"
#include "runtime/plan/specialisation.hpp"
#include "scene/quality.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen {

/// What of a device a plan depends on.
struct DeviceLimits {
  int max_texture_size = 4096;
  int max_array_layers = 256;
  bool clip_control = false;
  bool compute_shaders = false;  // with images that they write
  bool software = false;         // the processor draws: triangles are dear, its time is ours
};

enum class PipelineKind {
  tureen,     // visibility pass, then shading of covered pixels; or forward
  published,  // a likeness of the published DiffSoup viewer, the baseline that speed is held
              // against
};

enum class ShadingSite {
  forward,   // colour in the only pass
  deferred,  // a visibility pass names the winning fragment, a shading pass colours it
  nowhere,   // the triangles with an empty fragment shader: depth, and no colour but the
             // background's. How fast a device can be asked to draw them at all (a ceiling)
};

/// The kind of shader that runs the shading pass of a deferred plan.
enum class ShadingStage {
  fragment,  // a triangle over the window; the depth test rejects the background
  compute,   // a compute shader, an invocation for every pixel of the picture
};

struct PlanPreferences {
  PipelineKind pipeline = PipelineKind::tureen;
  /// Without it no specialisation is applied: every face is alpha-tested, every pixel shaded,
  /// network weights are uniforms.
  bool specialise = true;
  /// Which specialisations may be applied, where `specialise` is set.
  SpecialisationSet specialisations = SpecialisationSet::all();
  bool reversed_depth = true;            // where the device can
  std::optional<ShadingSite> site = {};  // the plan's own choice when absent
  /// Measured on software OpenGL alone (docs/benchmarks.md, "Shading as compute"): compute is equal
  /// where faces cover the whole picture, and slower elsewhere.
  ShadingStage shading_stage = ShadingStage::fragment;
  /// Alpha by cell may take so many bytes of the device; if more, it is stored by the texel: the
  /// same pictures, in more time.
  std::uint64_t most_alpha_cell_bytes = ~std::uint64_t(0);
  Quality quality = {};
};

/// How the texels of a lattice lie on the device.
struct LatticePlan {
  /// Every face has this level and the texels follow each other in slot order, so that a formula
  /// finds them; -1: a table says where the texels of each slot lie, which costs 16 bytes a face
  /// and a read a fragment.
  int uniform_level = -1;
  /// Level of each slot on the device, below the soup's where a face is affine. Empty when the
  /// texels are uploaded as the soup has them.
  std::vector<std::uint8_t> levels;
  /// Alpha is stored by the cell, read once a fragment, or by the texel, read three times, in less
  /// than a third of the memory.
  bool alpha_by_cell = true;
  /// Bytes that alpha by cell would take, where that is too much.
  std::uint64_t refused_alpha_cell_bytes = 0;
};

struct RenderPlan {
  PipelineKind pipeline = PipelineKind::tureen;
  ShadingSite site = ShadingSite::deferred;
  bool reversed_depth = false;

  /// The faces that are drawn, by their slot on the device: opaque ones first, near ones together.
  std::vector<std::uint32_t> faces;
  /// Slots below this need no alpha test.
  std::size_t opaque_count = 0;
  /// Runs of slots that are drawn together; none straddles opaque_count.
  std::vector<Cluster> clusters;

  /// Frame by frame faces that cover no pixel's centre are found and not drawn (covered_faces.hpp).
  bool drops_faces_between_pixels = false;

  bool flat_colors = false;  // one colour a face says it all, whatever the soup stores
  bool color_mlp = false;    // the network runs
  MlpWeights mlp_weights = MlpWeights::uniforms;
  bool view_direction = false;   // the network sees it
  bool latent_features = false;  // the network sees features 4 and above
  bool depth_rejects_background = false;
  int harmonics_degree = 0;
  FeatureRanges feature_ranges;  // of what the network sees, for constant weights
  LatticePlan lattice;

  /// `fragment` where there is no choice.
  ShadingStage shading_stage = ShadingStage::fragment;
  Quality quality;

  /// In the order in which they were found; each of them once.
  std::vector<AppliedSpecialisation> applied;
  bool applies(Specialisation what) const;

  // Facts on the soup and the request, for people and for tests.

  std::string appearance;            // appearance_name() of the soup
  std::size_t soup_faces = 0;        // all of them
  std::size_t undrawable_faces = 0;  // without area, or with corners that are not finite: not drawn
  int zero_weights = 0;              // of the network, not computed
  bool specialise = true;            // PlanPreferences::specialise
  /// PlanPreferences::shading_stage: compute runs only where the plan is deferred.
  ShadingStage requested_stage = ShadingStage::fragment;
  /// --keep has no effect, as the published pipeline has no specialisations.
  bool ignores_specialisations = false;
};

/// The soup must have no defect(). Throws UsageError when the published pipeline is asked for and
/// cannot draw this soup, and for a quality with a defect(); DeviceLimitError for the compute stage
/// where there are no compute shaders.
RenderPlan make_plan(const TriangleSoup& soup, const DeviceLimits& limits,
                     const PlanPreferences& preferences = {});

}  // namespace tureen
