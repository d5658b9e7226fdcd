#include "runtime/tradeoff/knobs.hpp"

#include <algorithm>
#include <cassert>

#include "runtime/visibility_count.hpp"

namespace tureen::tradeoff {

namespace {

void unchanged(Applied&) {}

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
                             [level](Applied& applied) { applied.edits.lattice_level = level; }});
  knob.settings.front().apply = unchanged;
  return knob;
}

Knob texel_bits(const LatticeTexture& texture) {
  Knob knob{"texel_bits", "texel bits", {}};
  knob.settings.push_back({texture.is_float() ? "32" : "8", "bits as stored", unchanged});
  if (texture.is_float())
    knob.settings.push_back({"8", "8 bits a texel channel",
                             [](Applied& applied) { applied.edits.byte_texels = true; }});
  return knob;
}

Knob color() {
  const auto become = [](Edits::Color color) {
    return [color](Applied& applied) { applied.edits.color = color; };
  };
  return {"color",
          "colour",
          {{"network", "color MLP", unchanged},
           {"baked", "baked colour", become(Edits::Color::baked)},
           {"base", "base colour", become(Edits::Color::base)}}};
}

Knob triangle_budget(std::span<const std::uint64_t> visible_pixels) {
  Knob knob{"triangle_fraction", "triangle budget", {{"1", "all triangles", unchanged}}};
  // Few triangles have no tenth of them.
  if (visible_pixels.size() < 10) return knob;
  for (const double fraction : {0.5, 0.25, 0.1}) {
    const std::vector<std::uint8_t> keeps_face = most_visible(visible_pixels, fraction);
    knob.settings.push_back(
        {fraction == 0.5    ? "0.5"
         : fraction == 0.25 ? "0.25"
                            : "0.1",
         percent_text(fraction) + " of the triangles",
         [keeps_face](Applied& applied) { applied.edits.keeps_face = keeps_face; }});
  }
  return knob;
}

}  // namespace

std::vector<Knob> drawing_knobs(const TriangleSoup& soup,
                                std::span<const std::uint64_t> visible_pixels) {
  std::vector<Knob> knobs;
  if (const auto* texture = std::get_if<LatticeTexture>(&soup.appearance)) {
    knobs.push_back(lattice_level(*texture));
    knobs.push_back(texel_bits(*texture));
    if (texture->mlp) knobs.push_back(color());
  }
  knobs.push_back(triangle_budget(visible_pixels));
  // A lattice of level 0 has no coarser one.
  std::erase_if(knobs, [](const Knob& knob) { return knob.settings.size() < 2; });
  return knobs;
}

std::vector<Knob> antialiasing_knobs(int most_samples) {
  Knob scale{"resolution_scale", "resolution scale", {{"1", "full resolution", unchanged}}};
  for (const double factor : {0.75, 0.5})
    scale.settings.push_back(
        {factor == 0.5 ? "0.5" : "0.75", percent_text(factor) + " of the rows and columns",
         [factor](Applied& applied) { applied.quality.resolution_scale = factor; }});
  Knob samples{supersampling_key, "supersampling", {{"1", "one sample a pixel", unchanged}}};
  for (int n = 2; n <= most_samples; n *= 2)
    samples.settings.push_back({std::to_string(n),
                                std::to_string(n) + " x " + std::to_string(n) + " samples a pixel",
                                [n](Applied& applied) { applied.quality.supersampling = n; }});
  return {scale, samples};
}

std::vector<int> setting_counts(const std::vector<Knob>& knobs) {
  std::vector<int> counts;
  for (const Knob& knob : knobs) counts.push_back(int(knob.settings.size()));
  return counts;
}

Applied applied_by(const std::vector<Knob>& knobs, const Configuration& configuration) {
  assert(knobs.size() == configuration.size());
  Applied applied;
  for (std::size_t i = 0; i < knobs.size(); ++i)
    knobs[i].settings[std::size_t(configuration[i])].apply(applied);
  return applied;
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
