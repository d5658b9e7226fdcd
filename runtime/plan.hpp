// What is drawn for this scene on this device, and what was left out. Made once, without GL; the
// pipelines below obey it. Every row that the sentences name is proven by a test against the
// plan made with `specialise = false`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "runtime/color_mlp_source.hpp"
#include "runtime/draw_order.hpp"
#include "runtime/specialisation.hpp"
#include "soup/quality.hpp"
#include "soup/triangle_soup.hpp"

namespace tureen {

/// What of a device a plan depends on.
struct DeviceLimits {
  int max_texture_size = 4096;
  int max_array_layers = 256;
  bool clip_control = false;
  bool compute_shaders = false;                // with images that they write
  bool software = false;  // the processor draws: triangles are dear, its time is ours
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

/// What runs the shading pass of a deferred plan that names faces.
enum class ShadingStage {
  fragment,  // a triangle over the window; the depth test rejects the background
  compute,   // a compute shader, an invocation for every pixel of the picture
};

struct PlanPreferences {
  PipelineKind pipeline = PipelineKind::tureen;
  /// Without it nothing is left out: every face is alpha-tested, every pixel shaded, network
  /// weights are uniforms.
  bool specialise = true;
  /// What may be left out, where `specialise` is set.
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

  /// What of Specialisation this plan leaves out.
  SpecialisationSet left_out;
  /// `fragment` where there is no choice.
  ShadingStage shading_stage = ShadingStage::fragment;
  Quality quality;

  /// For people: how the scene is drawn, a sentence for each quality setting that is applied, and
  /// one for each thing left out, with the measured margin.
  std::vector<std::string> sentences;
};

/// The soup must have no defect(). Throws UsageError when the published pipeline is asked for and
/// cannot draw this soup, and for a quality with a defect(); DeviceLimitError for the compute stage
/// where there are no compute shaders.
RenderPlan make_plan(const TriangleSoup& soup, const DeviceLimits& limits,
                     const PlanPreferences& preferences = {});

}  // namespace tureen
