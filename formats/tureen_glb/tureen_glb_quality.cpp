#include "formats/tureen_glb/tureen_glb_quality.hpp"

#include "formats/tureen_glb/tureen_glb_layout.hpp"

namespace tureen {

namespace layout = glb_layout;

namespace {

void read_texel_bits(const JsonView& view, StoredPreset& preset) {
  const auto bits = view.find("texel_bits");
  if (!bits) return;
  switch (bits->natural(32)) {
    case 32:
      return;
    case 8:
      preset.edits.byte_texels = true;
      return;
    case 4:
    case 16:
      preset.ignored.emplace_back("texel_bits");
      return;
    default:
      bits->fail("expected 4, 8, 16 or 32");
  }
}

void read_color(const JsonView& view, StoredPreset& preset) {
  // The default degree was 2. Degree 0 leaves one colour a texel.
  const auto degree = view.find("harmonics_degree");
  const bool is_constant = degree && degree->natural(2) == 0;
  const auto color = view.find("color");
  if (!color) return;
  const auto known = Edits::Color(color->one_of(layout::colors));
  if (known == Edits::Color::baked && !is_constant)
    preset.ignored.emplace_back("color");
  else
    preset.edits.color = known;
}

}  // namespace

nlohmann::json quality_json(const Quality& quality) {
  nlohmann::json json = nlohmann::json::object();
  if (quality.resolution_scale != 1) json["resolution_scale"] = quality.resolution_scale;
  if (quality.supersampling != 1) json["supersampling"] = quality.supersampling;
  if (quality.splat_order != Quality::SplatOrder::center)
    json["splat_order"] = name_of(quality.splat_order);
  return json;
}

StoredPreset read_preset(const JsonView& view) {
  if (!view.value().is_object()) view.fail("expected an object");
  StoredPreset preset;
  if (const auto scale = view.find("resolution_scale"))
    preset.quality.resolution_scale = scale->number();
  if (const auto samples = view.find("supersampling"))
    preset.quality.supersampling = int(samples->natural(8));
  if (const auto order = view.find("splat_order"))
    preset.quality.splat_order = Quality::SplatOrder(order->one_of(splat_order_names));
  if (const auto reason = defect(preset.quality)) view.fail(*reason);
  if (const auto level = view.find("lattice_level"))
    preset.edits.lattice_level = int(level->natural(lattice::max_level));
  read_texel_bits(view, preset);
  read_color(view, preset);
  for (const char* key : {"feature_storage", "site", "alpha_to_coverage", "promised_psnr_db"})
    if (view.find(key)) preset.ignored.emplace_back(key);
  return preset;
}

}  // namespace tureen
