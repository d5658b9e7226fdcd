// The plan: the method of drawing a scene on a device, with the applied specialisations. It is
// computed once, without GL; the passes follow it. plan_description.hpp describes it in English.
// A test compares each specialisation with the plan made with `specialise = false`.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "runtime/plan/color_mlp_source.hpp"
#include "runtime/plan/draw_order.hpp"
#include "runtime/plan/specialisation.hpp"
#include "runtime/plan/splat_plan.hpp"
#include "scene/placed_layer.hpp"

namespace tureen {

/// Properties of a device that affect a plan.
struct DeviceLimits {
  int max_texture_size = 4096;
  int max_array_layers = 256;
  bool clip_control = false;
  bool compute_shaders = false;  // with writable images
  bool software = false;         // the processor draws: triangles are expensive and use its time
};

enum class ShadingSite {
  forward,   // colour in the only pass
  deferred,  // a visibility pass stores the visible fragment, a shading pass colours it
  nowhere,   // triangles with an empty fragment shader: depth only, colour of the background. Lower
             // bound of the time to draw them
};

/// The kind of shader in the shading pass of a deferred plan.
enum class ShadingStage {
  fragment,  // one triangle over the whole target
  compute,   // a compute shader with one invocation per pixel
};

struct PlanPreferences {
  /// Whether specialisations are applied. If false, every face is alpha-tested, every pixel is
  /// shaded, and network weights are uniforms.
  bool specialise = true;
  /// Allowed specialisations, if `specialise` is true.
  SpecialisationSet specialisations = SpecialisationSet::all();
  SpecialisationSet of_soups = SpecialisationSet::all();  // those of them that soups may have
  bool reversed_depth = true;                             // if the device supports it
  std::optional<ShadingSite> site = {};                   // default: chosen by the plan
  /// Measured only on software OpenGL (docs/benchmarks.md, "Shading stage"): compute is as
  /// fast if faces cover the whole image, and slower otherwise.
  ShadingStage shading_stage = ShadingStage::fragment;
  /// Limit in bytes for alpha stored by cell (LatticePlan::alpha_by_cell). Above it, alpha is
  /// stored by texel: identical images, but slower.
  std::uint64_t max_alpha_cell_bytes = ~std::uint64_t(0);
  Quality quality = {};
  std::optional<SplatProfile> splat_profile = {};  // of all splats; default: their own
  SplatBlending splat_blending = SplatBlending::automatic;
  bool as_published = false;  // SplatPlan::as_published
};

/// The layout of lattice texels on the device.
struct LatticePlan {
  /// Common level of all faces: texels follow each other in slot order and a formula locates them.
  /// -1: a table locates them; it costs 16 bytes per face and one read per fragment.
  int uniform_level = -1;
  /// Level of each slot on the device; below the soup's for affine faces. Empty if the texels are
  /// uploaded unchanged.
  std::vector<std::uint8_t> levels;
  /// Alpha is stored by cell (one read per fragment) or by texel (three reads per fragment, less
  /// than a third of the memory).
  bool alpha_by_cell = true;
  /// The bytes of alpha by cell, if they exceed max_alpha_cell_bytes; otherwise 0.
  std::uint64_t refused_alpha_cell_bytes = 0;
};

/// The method of drawing one soup.
struct SoupPlan {
  ShadingSite site = ShadingSite::deferred;
  /// `fragment` for plans without a shading pass.
  ShadingStage shading_stage = ShadingStage::fragment;

  /// faces[slot] is the face of the soup that this slot of the device draws. Opaque faces come
  /// first; each part is sorted spatially.
  std::vector<std::uint32_t> faces;
  /// Number of opaque slots, which come first and need no alpha test.
  std::size_t opaque_count = 0;
  /// Runs of slots drawn together; each is entirely below or above opaque_count.
  std::vector<Cluster> clusters;

  /// Small-triangle culling: each frame skips faces that cover no pixel centre (covered_faces.hpp).
  bool drops_small_triangles = false;

  bool flat_colors = false;  // each face has one constant colour, whatever its stored appearance
  bool color_mlp = false;    // the network is evaluated
  MlpWeights mlp_weights = MlpWeights::uniforms;
  bool view_direction = false;   // the network uses it
  bool latent_features = false;  // the network uses features 4 and above
  bool depth_rejects_background = false;
  int harmonics_degree = 0;
  FeatureRanges feature_ranges;  // of the network's inputs: constant weights need them to find
                                 // neurons that never fire
  LatticePlan lattice;

  /// In the order of discovery, without duplicates.
  std::vector<AppliedSpecialisation> applied;

  // Facts about the soup, for messages and tests.

  std::string appearance;            // appearance_name() of the soup
  std::size_t soup_faces = 0;        // all faces
  std::size_t undrawable_faces = 0;  // no area or non-finite corners: not drawn
  int zero_weights = 0;              // in the network, not computed
};

using LayerPlan = std::variant<SoupPlan, SplatPlan>;

/// The method of drawing a scene: what its layers share, and a plan for each layer.
struct RenderPlan {
  bool reversed_depth = false;
  Quality quality;
  bool specialise = true;  // PlanPreferences::specialise
  /// PlanPreferences::shading_stage: compute runs only if the plan is deferred.
  ShadingStage requested_stage = ShadingStage::fragment;
  /// Shared with the layers on the device, which follow it; not null.
  std::vector<std::shared_ptr<LayerPlan>> layers;
  /// Whether tiles (splatting/) blend the splats, so the device does not hold them.
  bool splats_in_tiles = false;
  /// If not empty, describe() returns these sentences. Set by plans whose passes come from outside
  /// runtime/.
  std::vector<std::string> description;

  /// The plan of a layer that is a soup, and of a layer of splats.
  SoupPlan& soup(std::size_t layer) { return std::get<SoupPlan>(*layers[layer]); }
  const SoupPlan& soup(std::size_t layer) const { return std::get<SoupPlan>(*layers[layer]); }
  const SplatPlan& splats(std::size_t layer) const { return std::get<SplatPlan>(*layers[layer]); }
  void add(LayerPlan layer) { layers.push_back(std::make_shared<LayerPlan>(std::move(layer))); }

  /// Whether a layer applies it.
  bool applies(Specialisation what) const;
  /// The specialisations of all layers, in their order.
  std::vector<AppliedSpecialisation> applied() const;
};

/// The plan of layers whose primitives have no defect(). Several soups are all deferred, with
/// shading in fragment shaders. Throws UsageError for
/// - a quality with a defect(), more than max_layers layers, and as make_splat_plan()
/// - SplatBlending::tiles or the exact order, if tiles cannot blend the splats
/// - SplatBlending::raster with the exact order, and tiles with stochastic splats
/// Throws DeviceLimitError if the compute stage is requested without compute shaders.
RenderPlan make_plan(std::span<const PlacedLayer> layers, const DeviceLimits& limits,
                     const PlanPreferences& preferences = {});
/// The same for one soup.
RenderPlan make_plan(const TriangleSoup& soup, const DeviceLimits& limits,
                     const PlanPreferences& preferences = {});

/// Changes a plan made for a single soup into the plan of one layer among several. Such layers are
/// drawn with other passes. The prepared data stays valid.
void make_layered(SoupPlan& plan);

}  // namespace tureen
