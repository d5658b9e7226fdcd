#include "jobs/tradeoff/quality_settings.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "jobs/visibility/visibility_count.hpp"
#include "scene/edit/lattice_refine.hpp"

namespace tureen::tradeoff {

namespace {

void unchanged(Applied&) {}

std::string percent_text(double fraction) {
  std::string text = std::to_string(int(fraction * 100 + 0.5));
  return text + " %";
}

QualitySetting lattice_level(const LatticeTexture& texture) {
  QualitySetting setting{"lattice_level", "lattice level", {}};
  for (int level = highest_level(texture); level >= 0; --level)
    setting.values.push_back({std::to_string(level), "lattice level " + std::to_string(level),
                              [level](Applied& applied) { applied.edits.lattice_level = level; }});
  setting.values.front().apply = unchanged;
  return setting;
}

QualitySetting texel_bits(const LatticeTexture& texture) {
  QualitySetting setting{"texel_bits", "texel bits", {}};
  setting.values.push_back({texture.is_float() ? "32" : "8", "bits as stored", unchanged});
  if (texture.is_float())
    setting.values.push_back({"8", "8 bits a texel channel",
                              [](Applied& applied) { applied.edits.byte_texels = true; }});
  return setting;
}

QualitySetting color() {
  const auto become = [](Edits::Color color) {
    return [color](Applied& applied) { applied.edits.color = color; };
  };
  return {"color",
          "colour",
          {{"network", "color MLP", unchanged},
           {"baked", "baked colour", become(Edits::Color::baked)},
           {"base", "base colour", become(Edits::Color::base)}}};
}

QualitySetting triangle_budget(std::span<const std::uint64_t> visible_pixels) {
  QualitySetting setting{
      "triangle_fraction", "triangle budget", {{"1", "all triangles", unchanged}}};
  // Below ten triangles there is no tenth.
  if (visible_pixels.size() < 10) return setting;
  for (const double fraction : {0.5, 0.25, 0.1}) {
    const std::vector<std::uint8_t> keeps_face = most_visible(visible_pixels, fraction);
    setting.values.push_back(
        {fraction == 0.5    ? "0.5"
         : fraction == 0.25 ? "0.25"
                            : "0.1",
         percent_text(fraction) + " of the triangles",
         [keeps_face](Applied& applied) { applied.edits.keeps_face = keeps_face; }});
  }
  return setting;
}

QualitySetting splat_fraction(std::span<const std::uint64_t> weights) {
  QualitySetting setting{"splat_fraction", "splats", {{"1", "all splats", unchanged}}};
  for (const auto& [fraction, name] : {std::pair{0.9, "0.9"}, std::pair{0.75, "0.75"},
                                       std::pair{0.5, "0.5"}, std::pair{0.25, "0.25"}}) {
    const std::vector<std::uint8_t> keeps_splat = most_visible(weights, fraction);
    setting.values.push_back(
        {name, percent_text(fraction) + " of the splats",
         [keeps_splat](Applied& applied) { applied.splat_edits.keeps_splat = keeps_splat; }});
  }
  return setting;
}

QualitySetting splat_order() {
  const auto become = [](Quality::SplatOrder order) {
    return [order](Applied& applied) { applied.quality.splat_order = order; };
  };
  return {"splat_order",
          "splat order",
          {{"centre", "order of the centres", unchanged},
           {"exact", "exact order", become(Quality::SplatOrder::exact)},
           {"stochastic", "stochastic", become(Quality::SplatOrder::stochastic)}}};
}

}  // namespace

bool has_edits(const Applied& applied) {
  return applied.edits != Edits{} || applied.splat_edits != SplatEdits{};
}

std::string describe_edits(const Applied& applied) {
  return applied.splat_edits != SplatEdits{} ? describe(applied.splat_edits)
                                             : describe(applied.edits);
}

Scene edited(Scene scene, const Applied& applied, const std::function<void(double)>& progress) {
  Primitives& primitives = only_layer(scene).primitives;
  if (auto* soup = std::get_if<TriangleSoup>(&primitives))
    *soup = edited(std::move(*soup), applied.edits, progress);
  else
    scene = edited(std::move(scene), applied.splat_edits);
  return scene;
}

std::vector<QualitySetting> drawing_settings(const Splats& splats,
                                             std::span<const std::uint64_t> weights) {
  std::vector<QualitySetting> settings{splat_order()};
  // Below ten splats there is no tenth.
  if (weights.size() >= 10) settings.push_back(splat_fraction(weights));
  const std::vector<std::uint8_t> opaque = nearly_opaque_windows(splats);
  if (std::count(opaque.begin(), opaque.end(), 1) > 0)
    settings.push_back({"opaque_windows",
                        "opaque windows",
                        {{"false", "all windows blended", unchanged},
                         {"true", "nearly opaque windows as triangles",
                          [](Applied& applied) { applied.splat_edits.opaque_windows = true; }}}});
  return settings;
}

std::vector<QualitySetting> drawing_settings(const TriangleSoup& soup,
                                             std::span<const std::uint64_t> visible_pixels) {
  std::vector<QualitySetting> settings;
  if (const auto* texture = std::get_if<LatticeTexture>(&soup.appearance)) {
    settings.push_back(lattice_level(*texture));
    settings.push_back(texel_bits(*texture));
    if (texture->mlp) settings.push_back(color());
  }
  settings.push_back(triangle_budget(visible_pixels));
  // A setting with a single value has no effect, e.g. the lattice level of a level-0 texture.
  std::erase_if(settings, [](const QualitySetting& setting) { return setting.values.size() < 2; });
  return settings;
}

std::vector<QualitySetting> antialiasing_settings(int max_samples, bool has_splats) {
  QualitySetting scale{
      "resolution_scale", "resolution scale", {{"1", "full resolution", unchanged}}};
  for (const double factor : {0.75, 0.5})
    scale.values.push_back(
        {factor == 0.5 ? "0.5" : "0.75", percent_text(factor) + " of the rows and columns",
         [factor](Applied& applied) { applied.quality.resolution_scale = factor; }});
  QualitySetting samples{
      "supersampling", "supersampling", {{"1", "one sample per pixel", unchanged}}};
  for (int n = 2; n <= max_samples; n *= 2)
    samples.values.push_back({std::to_string(n),
                              std::to_string(n) + " x " + std::to_string(n) + " samples per pixel",
                              [n](Applied& applied) { applied.quality.supersampling = n; }});
  if (has_splats) return {scale, samples, splat_order()};
  return {scale, samples};
}

std::vector<int> value_counts(const std::vector<QualitySetting>& settings) {
  std::vector<int> counts;
  for (const QualitySetting& setting : settings) counts.push_back(int(setting.values.size()));
  return counts;
}

Applied applied_by(const std::vector<QualitySetting>& settings,
                   const Configuration& configuration) {
  assert(settings.size() == configuration.size());
  Applied applied;
  for (std::size_t i = 0; i < settings.size(); ++i)
    settings[i].values[std::size_t(configuration[i])].apply(applied);
  return applied;
}

std::string describe(const std::vector<QualitySetting>& settings,
                     const Configuration& configuration) {
  assert(settings.size() == configuration.size());
  std::string text;
  for (std::size_t i = 0; i < settings.size(); ++i)
    if (configuration[i] != 0)
      text += (text.empty() ? "" : ", ") + settings[i].values[std::size_t(configuration[i])].words;
  return text.empty() ? "defaults" : text;
}

}  // namespace tureen::tradeoff
