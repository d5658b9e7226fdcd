#include "soup/render_preset.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "soup/triangle_soup.hpp"

namespace tureen {

namespace {

/// "0.75", "3": as many digits as a reader wants.
std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  std::replace(text, text + sizeof text, ',', '.');  // the program around us may have set a locale
  return text;
}

bool is_one_of(int value, std::initializer_list<int> values) {
  return std::find(values.begin(), values.end(), value) != values.end();
}

std::string outside(const char* knob, double value, const char* range) {
  return std::string("the preset's ") + knob + " is " + number(value) + ", not " + range;
}

std::optional<std::string> out_of_range(const RenderPreset& p) {
  if (p.lattice_level < 0 || p.lattice_level > lattice::max_level)
    return outside("lattice level", p.lattice_level, "0 to 7");
  if (!is_one_of(p.texel_bits, {4, 8, 16, 32}))
    return outside("bits a texel channel", p.texel_bits, "4, 8, 16 or 32");
  if (p.harmonics_degree < 0 || p.harmonics_degree > 2)
    return outside("degree of harmonics", p.harmonics_degree, "0, 1 or 2");
  // Written so that NaN is refused, too.
  if (!(p.triangle_fraction > 0 && p.triangle_fraction <= 1))
    return outside("fraction of triangles", p.triangle_fraction, "above 0 and at most 1");
  if (!(p.resolution_scale >= 0.25 && p.resolution_scale <= 1))
    return outside("resolution scale", p.resolution_scale, "0.25 to 1");
  if (p.supersampling < 1 || p.supersampling > 8)
    return outside("supersampling", p.supersampling, "1 to 8");
  if (!is_one_of(p.alpha_to_coverage, {0, 2, 4, 8}))
    return outside("number of samples with alpha to coverage", p.alpha_to_coverage, "0, 2, 4 or 8");
  if (p.promised_psnr_db && !(*p.promised_psnr_db >= 0 && *p.promised_psnr_db <= 100))
    return outside("promised PSNR", *p.promised_psnr_db, "0 to 100 dB");
  return std::nullopt;
}

}  // namespace

RenderPreset combined(RenderPreset preset, const RenderPreset& asked) {
  const RenderPreset plain;
  if (asked.lattice_level != plain.lattice_level) preset.lattice_level = asked.lattice_level;
  if (asked.texel_bits != plain.texel_bits) preset.texel_bits = asked.texel_bits;
  if (asked.color != plain.color) {
    preset.color = asked.color;
    preset.harmonics_degree = asked.harmonics_degree;
  }
  if (asked.triangle_fraction != plain.triangle_fraction) {
    preset.triangle_fraction = asked.triangle_fraction;
    preset.keeps_face = asked.keeps_face;
  }
  if (asked.feature_storage != plain.feature_storage)
    preset.feature_storage = asked.feature_storage;
  if (asked.site != plain.site) preset.site = asked.site;
  if (asked.resolution_scale != plain.resolution_scale ||
      asked.supersampling != plain.supersampling) {
    preset.resolution_scale = asked.resolution_scale;
    preset.supersampling = asked.supersampling;
  }
  if (asked.alpha_to_coverage != plain.alpha_to_coverage)
    preset.alpha_to_coverage = asked.alpha_to_coverage;
  return preset;
}

bool keeps_data(const RenderPreset& preset) {
  const RenderPreset faithful;
  return preset.lattice_level == faithful.lattice_level &&
         preset.texel_bits == faithful.texel_bits && preset.color == faithful.color &&
         preset.triangle_fraction == faithful.triangle_fraction;
}

bool is_faithful(const RenderPreset& preset) {
  const RenderPreset faithful;
  return keeps_data(preset) && preset.feature_storage == faithful.feature_storage &&
         preset.site == faithful.site && preset.resolution_scale == faithful.resolution_scale &&
         preset.supersampling == faithful.supersampling &&
         preset.alpha_to_coverage == faithful.alpha_to_coverage;
}

std::string describe(const RenderPreset& preset) {
  using Preset = RenderPreset;
  const Preset faithful;
  std::string text;
  const auto add = [&](const std::string& words) { text += (text.empty() ? "" : ", ") + words; };
  if (preset.lattice_level != faithful.lattice_level)
    add("lattice level at most " + std::to_string(preset.lattice_level));
  if (preset.texel_bits != faithful.texel_bits)
    add(std::to_string(preset.texel_bits) + " bits a texel channel");
  if (preset.color == Preset::Color::harmonics)
    add("baked harmonics of degree " + std::to_string(preset.harmonics_degree));
  if (preset.color == Preset::Color::base) add("base colour without the network");
  if (preset.triangle_fraction != faithful.triangle_fraction)
    add("the most visible " + number(100 * preset.triangle_fraction) + " % of the triangles");
  if (preset.feature_storage == Preset::FeatureStorage::rgba16f) add("features as half floats");
  if (preset.feature_storage == Preset::FeatureStorage::rgba8) add("features as bytes");
  if (preset.site == Preset::Site::deferred) add("shaded once a pixel");
  if (preset.site == Preset::Site::forward) add("shaded once a fragment");
  if (preset.resolution_scale != faithful.resolution_scale)
    add(number(100 * preset.resolution_scale) + " % of the rows and columns");
  if (preset.supersampling != faithful.supersampling)
    add(std::to_string(preset.supersampling) + " x " + std::to_string(preset.supersampling) +
        " samples a pixel");
  if (preset.alpha_to_coverage != faithful.alpha_to_coverage)
    add("alpha to coverage of " + std::to_string(preset.alpha_to_coverage) + " samples");
  return text.empty() ? "faithful" : text;
}

std::optional<std::string> defect(const RenderPreset& preset) {
  if (auto reason = out_of_range(preset)) return reason;
  if (preset.keeps_face.empty() != (preset.triangle_fraction == 1))
    return preset.keeps_face.empty()
               ? "the preset draws a part of the triangles and does not say which"
               : "the preset draws all triangles, and yet not every one";
  for (const std::uint8_t kept : preset.keeps_face)
    if (kept > 1) return "the preset says of a face neither that it is drawn nor that it is not";
  const bool features = preset.feature_storage != RenderPreset::FeatureStorage::visibility;
  if (features && preset.site == RenderPreset::Site::forward)
    return "the preset keeps features for a shading pass, and shades every fragment at once";
  if (preset.alpha_to_coverage > 0 && (features || preset.site == RenderPreset::Site::deferred))
    return "the preset asks for alpha to coverage, which shades every fragment at once, and for a "
           "shading pass";
  if (preset.resolution_scale < 1 && preset.supersampling > 1)
    return "the preset asks for fewer samples than pixels, and for more";
  return std::nullopt;
}

std::optional<std::string> defect(const RenderPreset& preset, const TriangleSoup& soup) {
  if (auto reason = defect(preset)) return reason;
  if (!preset.keeps_face.empty() && preset.keeps_face.size() != soup.triangles.size())
    return "the preset chooses among " + std::to_string(preset.keeps_face.size()) +
           " triangles, and the scene has " + std::to_string(soup.triangles.size());
  return std::nullopt;
}

}  // namespace tureen
