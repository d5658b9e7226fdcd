#include "runtime/debug_views/debug_views.hpp"

#include <utility>

#include "base/error.hpp"
#include "runtime/debug_views/debug_view_passes.hpp"
#include "runtime/passes/targets.hpp"

namespace tureen {

namespace {

/// A plan that draws all faces and stores all values.
RenderPlan debug_view_plan(const TriangleSoup& soup, const DeviceLimits& limits,
                           bool reversed_depth) {
  SpecialisationSet exact;
  exact.add(Specialisation::weight_uniforms);
  exact.add(Specialisation::dead_neurons);
  RenderPlan plan = make_plan(
      soup, limits,
      {.specialisations = exact, .reversed_depth = reversed_depth, .site = ShadingSite::deferred});
  plan.layers.front().latent_features = feature_count(soup) > 4;
  return plan;
}

}  // namespace

PreparedScene prepare_debug_views(const TriangleSoup& soup, glm::dvec3 origin,
                                  const DeviceLimits& device, const RenderOptions& options) {
  const DeviceLimits limits = options.limits.value_or(device);
  PreparedScene prepared = prepare_scene(
      soup, origin, limits, debug_view_plan(soup, limits, options.plan.reversed_depth));
  // Stores that face_corners.glsl and debug_view.frag read.
  const std::vector<std::uint32_t>& faces = prepared.plan.layers.front().faces;
  AppearanceSource& appearance = prepared.layers.front().soup->appearance;
  std::vector<glm::vec3> corners;
  corners.reserve(3 * faces.size());
  for (const std::uint32_t face : faces)
    for (int k = 0; k < 3; ++k) corners.push_back(soup.positions[soup.triangles[face][k]]);
  appearance.samplers.push_back(
      {"corners", TexelSource::of(texel_formats::rgb32f, std::move(corners), "corners")});
  appearance.samplers.push_back(
      {"soup_faces", TexelSource::of(texel_formats::r32ui, faces, "faces")});
  appearance.fit_layout(TexelLayout::of(limits));
  return prepared;
}

struct DebugViews::State {
  DebugViewSubject subject;
  ShownDebugView shown = {};
  const FragmentCountPass* counts = nullptr;  // of the renderer's passes
  bool has_passes = false;                    // for shown.what
};

DebugViews::DebugViews(const TriangleSoup& soup) : state_(new State{DebugViewSubject(soup)}) {}
DebugViews::~DebugViews() = default;
DebugViews::DebugViews(DebugViews&&) noexcept = default;
DebugViews& DebugViews::operator=(DebugViews&&) noexcept = default;

void DebugViews::require(DebugView what, const FeatureChoice& features) const {
  const DebugViewSubject& subject = state_->subject;
  if (const auto& refusal = subject.refusals[std::size_t(what)]) throw UsageError(*refusal);
  if (what == DebugView::features)
    if (const auto refusal = why_not(features, subject.features)) throw UsageError(*refusal);
}

void DebugViews::show(Renderer& renderer, DebugView what, const FeatureChoice& features) {
  require(what, features);
  State& state = *state_;
  const bool has_passes = std::exchange(state.has_passes, true) && what == state.shown.what;
  state.shown.what = what;
  state.shown.features = features;
  if (has_passes) return;
  DebugViewPasses made = debug_view_passes(*renderer.soups().front(), state.subject, state.shown);
  state.counts = made.counts;
  renderer.set_passes(std::move(made.passes));
}

std::vector<std::uint8_t> DebugViews::read_fragment_counts() const {
  if (!state_->counts) return {};
  const glm::ivec2 size = state_->counts->size();
  const Image8 image = read_pixels(state_->counts->framebuffer(), size.x, size.y);
  std::vector<std::uint8_t> result(image.pixels.size());
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = image.pixels[i].r;
  return result;
}

Legend DebugViews::legend() const {
  return tureen::legend(state_->shown.what, state_->shown.scale, state_->shown.features);
}

}  // namespace tureen
