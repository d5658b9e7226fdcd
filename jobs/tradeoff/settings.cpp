#include "jobs/tradeoff/settings.hpp"

#include <algorithm>
#include <cassert>
#include <initializer_list>
#include <utility>

#include "jobs/visibility/visibility_count.hpp"
#include "scene/edit/lattice_refine.hpp"

namespace tureen::tradeoff {

namespace {

/// Fractions of primitives and of resolution: the value, its name, and its percentage.
struct Fraction {
  double value;
  const char* name;
  const char* percent;
};

/// A setting that keeps the most visible primitives, with its default. Below ten primitives there
/// is no tenth: it has no other value.
QualitySetting budget(QualitySetting setting, const char* what,
                      std::span<const std::uint64_t> visible, std::initializer_list<Fraction> list,
                      std::vector<std::uint8_t>& (*keeps)(Applied&)) {
  if (visible.size() < 10) return setting;
  for (const Fraction& fraction : list) {
    SettingValue value{fraction.name, std::string(fraction.percent) + " of the " + what};
    keeps(value.change) = most_visible(visible, fraction.value);
    setting.values.push_back(std::move(value));
  }
  return setting;
}

QualitySetting lattice_level(const LatticeTexture& texture) {
  QualitySetting setting{"lattice_level", "lattice level", {}};
  const int highest = highest_level(texture);
  for (int level = highest; level >= 0; --level) {
    setting.values.push_back({std::to_string(level), "lattice level " + std::to_string(level)});
    if (level < highest) setting.values.back().change.edits.lattice_level = level;
  }
  return setting;
}

QualitySetting texel_bits(const LatticeTexture& texture) {
  QualitySetting setting{
      "texel_bits", "texel bits", {{texture.is_float() ? "32" : "8", "bits as stored"}}};
  if (texture.is_float())
    setting.values.push_back({"8", "8 bits per texel channel", {.edits = {.byte_texels = true}}});
  return setting;
}

QualitySetting color() {
  return {"color",
          "colour",
          {{"network", "color MLP"},
           {"baked", "baked colour", {.edits = {.color = Edits::Color::baked}}},
           {"base", "base colour", {.edits = {.color = Edits::Color::base}}}}};
}

QualitySetting splat_order() {
  using enum Quality::SplatOrder;
  return {"splat_order",
          "splat order",
          {{"centre", "order of the centres"},
           {"exact", "exact order", {.quality = {.splat_order = exact}}},
           {"stochastic", "stochastic", {.quality = {.splat_order = stochastic}}}}};
}

/// A setting with a single value has no effect, e.g. the lattice level of a level-0 texture.
std::vector<QualitySetting> without_constants(std::vector<QualitySetting> settings) {
  std::erase_if(settings, [](const QualitySetting& setting) { return setting.values.size() < 2; });
  return settings;
}

/// Copies a member that differs from its default.
template <typename T, typename M>
void take(T& into, const T& from, M T::*member) {
  if (from.*member != T{}.*member) into.*member = from.*member;
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

std::vector<QualitySetting> scene_settings(const Splats& splats,
                                           std::span<const std::uint64_t> weights) {
  std::vector<QualitySetting> settings{splat_order()};
  settings.push_back(budget(
      {"splat_fraction", "splats", {{"1", "all splats"}}}, "splats", weights,
      {{0.9, "0.9", "90 %"}, {0.75, "0.75", "75 %"}, {0.5, "0.5", "50 %"}, {0.25, "0.25", "25 %"}},
      [](Applied & applied) -> auto& { return applied.splat_edits.keeps_splat; }));
  const std::vector<std::uint8_t> opaque = nearly_opaque_windows(splats);
  if (std::count(opaque.begin(), opaque.end(), 1) > 0)
    settings.push_back({"opaque_windows",
                        "opaque windows",
                        {{"false", "all windows blended"},
                         {"true",
                          "nearly opaque windows as triangles",
                          {.splat_edits = {.opaque_windows = true}}}}});
  return without_constants(std::move(settings));
}

std::vector<QualitySetting> scene_settings(const TriangleSoup& soup,
                                           std::span<const std::uint64_t> visible_pixels) {
  std::vector<QualitySetting> settings;
  if (const auto* texture = std::get_if<LatticeTexture>(&soup.appearance)) {
    settings.push_back(lattice_level(*texture));
    settings.push_back(texel_bits(*texture));
    if (texture->mlp) settings.push_back(color());
  }
  settings.push_back(budget(
      {"triangle_fraction", "triangle budget", {{"1", "all triangles"}}}, "triangles",
      visible_pixels, {{0.5, "0.5", "50 %"}, {0.25, "0.25", "25 %"}, {0.1, "0.1", "10 %"}},
      [](Applied & applied) -> auto& { return applied.edits.keeps_face; }));
  return without_constants(std::move(settings));
}

std::vector<QualitySetting> antialiasing_settings(int max_samples, bool has_splats) {
  const QualitySetting scale{
      "resolution_scale",
      "resolution scale",
      {{"1", "full resolution"},
       {"0.75", "75 % of the rows and columns", {.quality = {.resolution_scale = 0.75}}},
       {"0.5", "50 % of the rows and columns", {.quality = {.resolution_scale = 0.5}}}}};
  QualitySetting samples{"supersampling", "supersampling", {{"1", "one sample per pixel"}}};
  for (int n = 2; n <= max_samples; n *= 2)
    samples.values.push_back({std::to_string(n),
                              std::to_string(n) + " x " + std::to_string(n) + " samples per pixel",
                              {.quality = {.supersampling = n}}});
  if (has_splats) return {scale, samples, splat_order()};
  return {scale, samples};
}

int departures(const Configuration& configuration) {
  return int(configuration.size()) - int(std::count(configuration.begin(), configuration.end(), 0));
}

Applied applied_by(const std::vector<QualitySetting>& settings,
                   const Configuration& configuration) {
  assert(settings.size() == configuration.size());
  Applied applied;
  for (std::size_t i = 0; i < settings.size(); ++i) {
    const Applied& change = settings[i].values[std::size_t(configuration[i])].change;
    take(applied.edits, change.edits, &Edits::keeps_face);
    take(applied.edits, change.edits, &Edits::lattice_level);
    take(applied.edits, change.edits, &Edits::color);
    take(applied.edits, change.edits, &Edits::byte_texels);
    take(applied.splat_edits, change.splat_edits, &SplatEdits::keeps_splat);
    take(applied.splat_edits, change.splat_edits, &SplatEdits::opaque_windows);
  }
  applied.quality = quality_of(settings, configuration);
  return applied;
}

Quality quality_of(const std::vector<QualitySetting>& settings,
                   const Configuration& configuration) {
  assert(settings.size() == configuration.size());
  Quality quality;
  for (std::size_t i = 0; i < settings.size(); ++i) {
    const Quality& change = settings[i].values[std::size_t(configuration[i])].change.quality;
    take(quality, change, &Quality::resolution_scale);
    take(quality, change, &Quality::supersampling);
    take(quality, change, &Quality::splat_order);
  }
  return quality;
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

std::vector<Configuration> single_changes(const std::vector<QualitySetting>& settings) {
  std::vector<Configuration> all{Configuration(settings.size(), 0)};
  for (std::size_t setting = 0; setting < settings.size(); ++setting)
    for (std::size_t value = 1; value < settings[setting].values.size(); ++value) {
      all.push_back(all.front());
      all.back()[setting] = int(value);
    }
  return all;
}

std::vector<Configuration> combinations(const std::vector<QualitySetting>& settings,
                                        std::span<const std::size_t> varied) {
  std::vector<Configuration> all{Configuration(settings.size(), 0)};
  for (const std::size_t setting : varied) {
    const std::vector<Configuration> before = all;
    for (std::size_t value = 1; value < settings[setting].values.size(); ++value)
      for (Configuration configuration : before) {
        configuration[setting] = int(value);
        all.push_back(std::move(configuration));
      }
  }
  std::erase_if(all, [&](const Configuration& each) {
    return departures(each) < 2 || defect(quality_of(settings, each));
  });
  return all;
}

}  // namespace tureen::tradeoff
