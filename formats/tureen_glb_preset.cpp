#include "formats/tureen_glb_preset.hpp"

#include "formats/tureen_glb_layout.hpp"

namespace tureen {

namespace layout = glb_layout;

nlohmann::json preset_json(const RenderPreset& preset) {
  const RenderPreset faithful;
  nlohmann::json json = nlohmann::json::object();
  if (preset.lattice_level != faithful.lattice_level) json["lattice_level"] = preset.lattice_level;
  if (preset.texel_bits != faithful.texel_bits) json["texel_bits"] = preset.texel_bits;
  if (preset.color != faithful.color) json["color"] = layout::colors[int(preset.color)];
  if (preset.harmonics_degree != faithful.harmonics_degree)
    json["harmonics_degree"] = preset.harmonics_degree;
  if (preset.triangle_fraction != faithful.triangle_fraction)
    json["triangle_fraction"] = preset.triangle_fraction;
  if (preset.feature_storage != faithful.feature_storage)
    json["feature_storage"] = layout::feature_storages[int(preset.feature_storage)];
  if (preset.site != faithful.site) json["site"] = layout::sites[int(preset.site)];
  if (preset.resolution_scale != faithful.resolution_scale)
    json["resolution_scale"] = preset.resolution_scale;
  if (preset.supersampling != faithful.supersampling) json["supersampling"] = preset.supersampling;
  if (preset.alpha_to_coverage != faithful.alpha_to_coverage)
    json["alpha_to_coverage"] = preset.alpha_to_coverage;
  if (preset.promised_psnr_db) json["promised_psnr_db"] = *preset.promised_psnr_db;
  return json;
}

RenderPreset read_preset(const JsonView& view) {
  RenderPreset preset;
  const auto read_whole = [&](const char* key, int& value, int most) {
    if (const auto member = view.find(key)) value = int(member->natural(std::uint64_t(most)));
  };
  const auto read_number = [&](const char* key, double& value) {
    if (const auto member = view.find(key)) value = member->number();
  };
  const auto read_name = [&](const char* key, auto& value, const auto& names) {
    using Enumeration = std::remove_reference_t<decltype(value)>;
    if (const auto member = view.find(key)) value = Enumeration(member->one_of(names));
  };
  if (!view.value().is_object()) view.fail("expected an object");
  read_whole("lattice_level", preset.lattice_level, lattice::max_level);
  read_whole("texel_bits", preset.texel_bits, 32);
  read_name("color", preset.color, layout::colors);
  read_whole("harmonics_degree", preset.harmonics_degree, 2);
  read_number("triangle_fraction", preset.triangle_fraction);
  read_name("feature_storage", preset.feature_storage, layout::feature_storages);
  read_name("site", preset.site, layout::sites);
  read_number("resolution_scale", preset.resolution_scale);
  read_whole("supersampling", preset.supersampling, 8);
  read_whole("alpha_to_coverage", preset.alpha_to_coverage, 8);
  if (const auto member = view.find("promised_psnr_db")) preset.promised_psnr_db = member->number();
  return preset;
}

}  // namespace tureen
