#include "runtime/tradeoff/knobs.hpp"

#include <algorithm>
#include <cassert>

#include "runtime/visibility_count.hpp"

namespace tureen::tradeoff {

namespace {

using Preset = RenderPreset;

void unchanged(Preset&) {}

std::string percent_text(double fraction) {
  std::string text = std::to_string(int(fraction * 100 + 0.5));
  return text + " %";
}

Knob lattice_level(const LatticeTexture& texture) {
  int finest = 0;
  for (const LatticePatch& patch : texture.patches) finest = std::max(finest, int(patch.level));
  Knob knob{"lattice_level", "lattice level", {}};
  for (int level = finest; level >= 0; --level)
    knob.settings.push_back({std::to_string(level), "lattice level " + std::to_string(level),
                             [level](Preset& preset) { preset.lattice_level = level; }});
  knob.settings.front().apply = unchanged;
  return knob;
}

Knob texel_bits(const LatticeTexture& texture) {
  Knob knob{"texel_bits", "texel bits", {}};
  for (const int bits : {32, 16, 8, 4})
    if (texture.is_float() || bits <= 8)
      knob.settings.push_back({std::to_string(bits), std::to_string(bits) + " bits a texel channel",
                               [bits](Preset& preset) { preset.texel_bits = bits; }});
  knob.settings.front().apply = unchanged;
  return knob;
}

Knob color() {
  Knob knob{"color", "colour", {{"network", "color MLP", unchanged}}};
  for (const int degree : {2, 1, 0})
    knob.settings.push_back({"harmonics_" + std::to_string(degree),
                             "baked harmonics of degree " + std::to_string(degree),
                             [degree](Preset& preset) {
                               preset.color = Preset::Color::harmonics;
                               preset.harmonics_degree = degree;
                             }});
  knob.settings.push_back(
      {"base", "base colour", [](Preset& preset) { preset.color = Preset::Color::base; }});
  return knob;
}

Knob feature_storage() {
  using Storage = Preset::FeatureStorage;
  const auto store = [](Storage storage) {
    return [storage](Preset& preset) { preset.feature_storage = storage; };
  };
  return {"feature_storage",
          "feature storage",
          {{"visibility", "visibility buffer", unchanged},
           {"rgba16f", "features as half floats", store(Storage::rgba16f)},
           {"rgba8", "features as bytes", store(Storage::rgba8)}}};
}

Knob shading_site(ShadingSite site) {
  const Setting forward{"forward", "shaded once a fragment",
                        [](Preset& preset) { preset.site = Preset::Site::forward; }};
  const Setting deferred{"deferred", "shaded once a pixel",
                         [](Preset& preset) { preset.site = Preset::Site::deferred; }};
  Knob knob{"site", "shading site", {forward, deferred}};
  if (site == ShadingSite::deferred) std::swap(knob.settings[0], knob.settings[1]);
  knob.settings[0].apply = unchanged;
  return knob;
}

Knob triangle_budget(std::span<const std::uint64_t> visible_pixels) {
  Knob knob{"triangle_fraction", "triangle budget", {{"1", "all triangles", unchanged}}};
  // Few triangles have no tenth of them.
  if (visible_pixels.size() < 10) return knob;
  for (const double fraction : {0.5, 0.25, 0.1}) {
    RenderPreset chosen;
    set_triangle_fraction(chosen, visible_pixels, fraction);
    knob.settings.push_back({fraction == 0.5    ? "0.5"
                             : fraction == 0.25 ? "0.25"
                                                : "0.1",
                             percent_text(fraction) + " of the triangles",
                             [chosen](Preset& preset) {
                               preset.triangle_fraction = chosen.triangle_fraction;
                               preset.keeps_face = chosen.keeps_face;
                             }});
  }
  return knob;
}

Knob mlp_precision() {
  const auto emulated = [](const char* value, const char* words, MlpPrecision precision) {
    return Setting{value, words, unchanged, precision};
  };
  return {"mlp_precision",
          "MLP precision",
          {{"float32", "floats", unchanged},
           emulated("half_weights", "MLP weights as half floats", MlpPrecision::half_weights),
           emulated("half", "MLP in half floats", MlpPrecision::half),
           emulated("int8_weights", "MLP weights in 8 bits", MlpPrecision::int8_weights),
           emulated("int8", "MLP in 8 bits", MlpPrecision::int8)}};
}

}  // namespace

std::vector<Knob> drawing_knobs(const TriangleSoup& soup, ShadingSite site,
                                std::span<const std::uint64_t> visible_pixels) {
  std::vector<Knob> knobs;
  bool network = false;
  if (const auto* texture = std::get_if<LatticeTexture>(&soup.appearance)) {
    network = texture->mlp.has_value();
    knobs.push_back(lattice_level(*texture));
    knobs.push_back(texel_bits(*texture));
    if (network) knobs.push_back(color());
  }
  if (network) knobs.push_back(feature_storage());
  knobs.push_back(shading_site(site));
  knobs.push_back(triangle_budget(visible_pixels));
  if (network) knobs.push_back(mlp_precision());
  // A lattice of level 0 has no coarser one.
  std::erase_if(knobs, [](const Knob& knob) { return knob.settings.size() < 2; });
  return knobs;
}

std::vector<Knob> antialiasing_knobs(int most_samples, std::span<const int> sample_counts) {
  Knob scale{"resolution_scale", "resolution scale", {{"1", "full resolution", unchanged}}};
  for (const double factor : {0.75, 0.5})
    scale.settings.push_back({factor == 0.5 ? "0.5" : "0.75",
                              percent_text(factor) + " of the rows and columns",
                              [factor](Preset& preset) { preset.resolution_scale = factor; }});
  Knob samples{supersampling_key, "supersampling", {{"1", "one sample a pixel", unchanged}}};
  for (int n = 2; n <= most_samples; n *= 2)
    samples.settings.push_back({std::to_string(n),
                                std::to_string(n) + " x " + std::to_string(n) + " samples a pixel",
                                [n](Preset& preset) { preset.supersampling = n; }});
  Knob coverage{"alpha_to_coverage", "alpha to coverage", {{"0", "alpha test", unchanged}}};
  for (const int n : {2, 4, 8}) {
    if (std::find(sample_counts.begin(), sample_counts.end(), n) == sample_counts.end()) continue;
    coverage.settings.push_back({std::to_string(n),
                                 "alpha to coverage of " + std::to_string(n) + " samples",
                                 [n](Preset& preset) { preset.alpha_to_coverage = n; }});
  }
  return {scale, samples, coverage};
}

std::vector<int> setting_counts(const std::vector<Knob>& knobs) {
  std::vector<int> counts;
  for (const Knob& knob : knobs) counts.push_back(int(knob.settings.size()));
  return counts;
}

RenderPreset preset_of(const std::vector<Knob>& knobs, const Configuration& configuration) {
  assert(knobs.size() == configuration.size());
  RenderPreset preset;
  for (std::size_t i = 0; i < knobs.size(); ++i)
    knobs[i].settings[std::size_t(configuration[i])].apply(preset);
  return preset;
}

MlpPrecision emulated_precision(const std::vector<Knob>& knobs,
                                const Configuration& configuration) {
  for (std::size_t i = 0; i < knobs.size(); ++i) {
    const MlpPrecision precision = knobs[i].settings[std::size_t(configuration[i])].emulated;
    if (precision != MlpPrecision::exact) return precision;
  }
  return MlpPrecision::exact;
}

std::string describe(const std::vector<Knob>& knobs, const Configuration& configuration) {
  assert(knobs.size() == configuration.size());
  std::string text;
  for (std::size_t i = 0; i < knobs.size(); ++i)
    if (configuration[i] != 0)
      text += (text.empty() ? "" : ", ") + knobs[i].settings[std::size_t(configuration[i])].words;
  return text.empty() ? "defaults" : text;
}

}  // namespace tureen::tradeoff
