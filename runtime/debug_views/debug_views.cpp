#include "runtime/debug_views/debug_views.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "base/error.hpp"
#include "runtime/debug_views/debug_view_passes.hpp"
#include "runtime/debug_views/measure_pass.hpp"
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

PreparedScene prepare_debug_views(std::span<const PlacedLayer> layers, const DeviceLimits& device,
                                  const RenderOptions& options) {
  const DeviceLimits limits = options.limits.value_or(device);
  SpecialisationSet exact;
  exact.add(Specialisation::weight_uniforms);
  exact.add(Specialisation::dead_neurons);
  // Splats are measured on the device, where only raster in the default order can draw them.
  RenderPlan plan = make_plan(layers, limits,
                              {.of_soups = exact,
                               .reversed_depth = options.plan.reversed_depth,
                               .site = ShadingSite::deferred,
                               .splat_blending = SplatBlending::raster});
  for (std::size_t i = 0; i < layers.size(); ++i)
    if (layers[i].soup) plan.soup(i).latent_features = feature_count(*layers[i].soup) > 4;
  PreparedScene prepared = prepare_scene(layers, limits, std::move(plan));
  for (std::size_t i = 0; i < layers.size(); ++i)
    if (layers[i].soup)
      add_debug_stores(*layers[i].soup, prepared.plan.soup(i).faces, limits,
                       prepared.layers[i].soup->appearance);
  return prepared;
}

struct DebugViews::State {
  std::vector<DebugViewSubject> subjects;  // for each layer
  ShownDebugView shown = {};
  // Of the renderer's passes, or null.
  const FragmentCountPass* counts = nullptr;
  const MeasurePass* measures = nullptr;
  bool has_passes = false;  // for shown.what and shown.as_values

  void use(Renderer& renderer, DebugView what, bool as_values);
};

DebugViews::DebugViews(std::span<const PlacedLayer> layers) : state_(new State) {
  for (const PlacedLayer& layer : layers)
    if (layer.soup)
      state_->subjects.emplace_back(*layer.soup);
    else
      state_->subjects.emplace_back(*layer.splats);
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

void DebugViews::State::use(Renderer& renderer, DebugView what, bool as_values) {
  const bool same = what == shown.what && as_values == shown.as_values;
  if (std::exchange(has_passes, false) && same) {
    has_passes = true;
    return;
  }
  shown.what = what;
  shown.as_values = as_values;
  DebugViewPasses made = debug_view_passes(renderer.soups(), renderer.splats(), subjects, shown);
  counts = made.counts;
  measures = made.measures;
  renderer.set_passes(std::move(made.passes));
  has_passes = true;  // not if making them threw
}

void DebugViews::show(Renderer& renderer, DebugView what, const FeatureChoice& features) {
  require(what, features);
  state_->shown.features = features;
  state_->use(renderer, what, false);
}

void DebugViews::measure(Renderer& renderer, DebugView what) {
  assert(what != DebugView::color && what != DebugView::quarter);
  require(what);
  state_->use(renderer, what, true);
}

std::vector<glm::vec4> DebugViews::read_values() const {
  return state_->measures ? state_->measures->read_values() : std::vector<glm::vec4>{};
}

std::vector<std::uint8_t> DebugViews::read_fragment_counts() const {
  if (!state_->counts || state_->measures) return {};
  const glm::ivec2 size = state_->counts->size();
  const Image8 image = read_pixels(state_->counts->framebuffer(), size.x, size.y);
  std::vector<std::uint8_t> result(image.pixels.size());
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = image.pixels[i].r;
  return result;
}

Legend DebugViews::legend() const {
  const auto& subjects = state_->subjects;
  const bool splats = std::all_of(subjects.begin(), subjects.end(),
                                  [](const DebugViewSubject& each) { return !each.shader; });
  return tureen::legend(state_->shown.what, state_->shown.scale, state_->shown.features,
                        splats ? Subjects::splats : Subjects::triangles);
}

}  // namespace tureen
