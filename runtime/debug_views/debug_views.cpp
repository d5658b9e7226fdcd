#include "runtime/debug_views/debug_views.hpp"

#include <utility>

#include "base/error.hpp"
#include "runtime/debug_views/debug_view_passes.hpp"
#include "runtime/passes/targets.hpp"

namespace tureen {

namespace {

/// Adds stores that face_corners.glsl and debug_view.frag read.
void add_debug_stores(const TriangleSoup& soup, const std::vector<std::uint32_t>& faces,
                      const DeviceLimits& limits, AppearanceSource& appearance) {
  std::vector<glm::vec3> corners;
  corners.reserve(3 * faces.size());
  for (const std::uint32_t face : faces)
    for (int k = 0; k < 3; ++k) corners.push_back(soup.positions[soup.triangles[face][k]]);
  appearance.samplers.push_back(
      {"corners", TexelSource::of(texel_formats::rgb32f, std::move(corners), "corners")});
  appearance.samplers.push_back(
      {"soup_faces", TexelSource::of(texel_formats::r32ui, faces, "faces")});
  appearance.fit_layout(TexelLayout::of(limits));
}

}  // namespace

PreparedScene prepare_debug_views(std::span<const PlacedSoup> layers, const DeviceLimits& device,
                                  const RenderOptions& options) {
  const DeviceLimits limits = options.limits.value_or(device);
  std::vector<const TriangleSoup*> soups;
  for (const PlacedSoup& layer : layers) soups.push_back(&layer.soup);
  SpecialisationSet exact;
  exact.add(Specialisation::weight_uniforms);
  exact.add(Specialisation::dead_neurons);
  RenderPlan plan = make_plan(soups, limits,
                              {.specialisations = exact,
                               .reversed_depth = options.plan.reversed_depth,
                               .site = ShadingSite::deferred});
  for (std::size_t i = 0; i < soups.size(); ++i)
    plan.soup(i).latent_features = feature_count(*soups[i]) > 4;
  PreparedScene prepared = prepare_scene(layers, limits, std::move(plan));
  for (std::size_t i = 0; i < soups.size(); ++i)
    add_debug_stores(*soups[i], prepared.plan.soup(i).faces, limits,
                     prepared.layers[i].soup->appearance);
  return prepared;
}

PreparedScene prepare_debug_views(const TriangleSoup& soup, glm::dvec3 origin,
                                  const DeviceLimits& device, const RenderOptions& options) {
  const PlacedSoup layer{soup, at_origin(origin)};
  return prepare_debug_views(std::span(&layer, 1), device, options);
}

struct DebugViews::State {
  std::vector<DebugViewSubject> subjects;  // for each soup
  ShownDebugView shown = {};
  const FragmentCountPass* counts = nullptr;  // of the renderer's passes
  bool has_passes = false;                    // for shown.what
};

DebugViews::DebugViews(std::span<const PlacedSoup> layers) : state_(new State) {
  for (const PlacedSoup& layer : layers) state_->subjects.emplace_back(layer.soup);
}
DebugViews::DebugViews(const TriangleSoup& soup) : state_(new State) {
  state_->subjects.emplace_back(soup);
}
DebugViews::~DebugViews() = default;
DebugViews::DebugViews(DebugViews&&) noexcept = default;
DebugViews& DebugViews::operator=(DebugViews&&) noexcept = default;

void DebugViews::require(DebugView what, const FeatureChoice& features) const {
  for (std::size_t i = 0; i < state_->subjects.size(); ++i) {
    const DebugViewSubject& subject = state_->subjects[i];
    std::optional<std::string> refusal = subject.refusals[std::size_t(what)];
    if (!refusal && what == DebugView::features) refusal = why_not(features, subject.features);
    if (!refusal) continue;
    const bool several = state_->subjects.size() > 1;
    throw UsageError(several ? "layer " + std::to_string(i + 1) + ": " + *refusal : *refusal);
  }
}

void DebugViews::show(Renderer& renderer, DebugView what, const FeatureChoice& features) {
  require(what, features);
  State& state = *state_;
  const bool has_passes = std::exchange(state.has_passes, false) && what == state.shown.what;
  state.shown.what = what;
  state.shown.features = features;
  state.has_passes = has_passes;
  if (has_passes) return;
  DebugViewPasses made = debug_view_passes(renderer.soups(), state.subjects, state.shown);
  state.counts = made.counts;
  renderer.set_passes(std::move(made.passes));
  state.has_passes = true;  // not if making them threw
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
