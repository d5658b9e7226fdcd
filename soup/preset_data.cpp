#include "soup/preset_data.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdio>

#include "soup/baked_color.hpp"
#include "soup/lattice_bytes.hpp"
#include "soup/lattice_levels.hpp"
#include "soup/lattice_refine.hpp"
#include "soup/quantise.hpp"

namespace tureen {

namespace {

template <class... Values>
std::string format(const char* pattern, Values... values) {
  char text[256];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

double mebibytes(double bytes) { return bytes / double(1 << 20); }

void round_to_halves(std::vector<float>& values) {
  for (float& value : values) value = float_from_half(half_from_float(value));
}

/// As round_to_halves, and every eighth value an alpha.
void round_texels_to_halves(std::vector<float>& values) {
  constexpr std::size_t channels = LatticeTexture::channels;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool is_alpha = i % channels == LatticeTexture::features;
    values[i] = float_from_half(is_alpha ? half_alpha(values[i]) : half_from_float(values[i]));
  }
}

void round_to_bytes(LatticeHarmonics& harmonics) {
  const auto* values = std::get_if<std::vector<float>>(&harmonics.coefficients);
  if (!values) return;
  float largest = 1e-6f;
  for (const float value : *values) largest = std::max(largest, std::abs(value));
  std::vector<std::int8_t> bytes;
  bytes.reserve(values->size());
  for (const float value : *values) bytes.push_back(quantised_signed(value, largest));
  harmonics.coefficients = std::move(bytes);
  harmonics.scale = largest;
}

class Turning {
 public:
  Turning(const TriangleSoup& soup, const RenderPreset& preset,
          const std::function<void(double)>& progress)
      : preset_(preset), progress_(progress), texture_(std::get<LatticeTexture>(soup.appearance)) {}

  /// Whether anything changed.
  bool run() {
    cap_level();
    choose_color();
    const int before = stored_texel_bits(texture_, 32);
    const int bits = stored_texel_bits(texture_, preset_.texel_bits);
    if (bits < before) {
      reduce_texel_bits(texture_, bits);
      const double channels = double(texture_.texel_count()) * LatticeTexture::channels;
      say(format("knob: %d bits a texel channel instead of %d, %.2f MiB of texels less", bits,
                 before, mebibytes(channels * (before - bits) / 8)));
    }
    return !sentences_.empty();
  }

  LatticeTexture texture() { return std::move(texture_); }
  std::vector<std::string> sentences() { return std::move(sentences_); }

 private:
  void say(std::string sentence) { sentences_.push_back(std::move(sentence)); }

  void cap_level() {
    if (highest_level(texture_) <= preset_.lattice_level) return;
    const std::size_t before = texture_.texel_count();
    texture_ = at_most_level(texture_, preset_.lattice_level, progress_);
    say(format("knob: no lattice above level %d, projected; %zu of %zu texels less",
               preset_.lattice_level, before - texture_.texel_count(), before));
  }

  void choose_color() {
    if (!texture_.mlp || preset_.color == RenderPreset::Color::network) return;
    if (preset_.color == RenderPreset::Color::base) {
      texture_ = base_color(std::move(texture_));
      return say("knob: the base colour without the color MLP");
    }
    texture_ = baked_color(texture_, {.degree = preset_.harmonics_degree, .progress = progress_});
    say(format("knob: the color MLP baked into harmonics of degree %d a texel",
               preset_.harmonics_degree));
  }

  const RenderPreset& preset_;
  const std::function<void(double)>& progress_;
  LatticeTexture texture_;
  std::vector<std::string> sentences_;
};

}  // namespace

int stored_texel_bits(const LatticeTexture& texture, int most) {
  return std::min(texture.is_float() ? 32 : 8, most);
}

void reduce_texel_bits(LatticeTexture& texture, int bits) {
  assert(bits == 32 || bits == 16 || bits == 8 || bits == 4);
  if (bits == 32) return;
  if (bits == 16) {
    if (auto* values = std::get_if<std::vector<float>>(&texture.texels))
      round_texels_to_halves(*values);
    if (texture.harmonics)
      if (auto* values = std::get_if<std::vector<float>>(&texture.harmonics->coefficients))
        round_to_halves(*values);
    return;
  }
  if (bits == 4) {
    std::vector<std::uint8_t> bytes;
    const std::size_t texels = texture.texel_count();
    bytes.reserve(texels * LatticeTexture::channels);
    for (std::size_t i = 0; i < texels; ++i)
      for (int c = 0; c < LatticeTexture::channels; ++c) {
        const float value = texture.value(i, c);
        bytes.push_back(
            std::uint8_t(17 * (c == LatticeTexture::features ? quantised_alpha4(value)
                                                             : quantised_unit4(value))));
      }
    texture.texels = std::move(bytes);
  } else {
    round_to_bytes(texture);
  }
  if (texture.harmonics) round_to_bytes(*texture.harmonics);
}

std::optional<PresetSoup> with_preset(const TriangleSoup& soup, const RenderPreset& preset,
                                      const std::function<void(double)>& progress) {
  if (!std::holds_alternative<LatticeTexture>(soup.appearance) || keeps_data(preset))
    return std::nullopt;
  Turning turning(soup, preset, progress);
  if (!turning.run()) return std::nullopt;
  std::optional<PresetSoup> result(std::in_place);
  result->soup.positions = soup.positions;
  result->soup.triangles = soup.triangles;
  result->soup.appearance.emplace<LatticeTexture>(turning.texture());
  result->sentences = turning.sentences();
  assert(!defect(result->soup));
  return result;
}

}  // namespace tureen
