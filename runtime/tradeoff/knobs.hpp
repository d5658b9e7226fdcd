// The knobs that a soup has: what each can be set to, and what that does to a render preset. The
// experiment (runtime/tradeoff/experiment.hpp) counts them, this says what they mean.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "runtime/plan.hpp"
#include "runtime/tradeoff/experiment.hpp"
#include "soup/mlp_precision.hpp"
#include "soup/render_preset.hpp"
#include "soup/triangle_soup.hpp"

namespace tureen::tradeoff {

struct Setting {
  std::string value;  // for programs: "3", "rgba8"
  std::string words;  // for people: "level 3", "features as bytes"
  std::function<void(RenderPreset&)> apply;
  /// Where the runtime has no such setting and the oracle emulates it: an error without a time.
  MlpPrecision emulated = MlpPrecision::exact;
};

struct Knob {
  std::string key;                // for programs: "lattice_level"
  std::string title;              // for people: "lattice level"
  std::vector<Setting> settings;  // the default first, whose apply changes nothing
};

/// The knobs that do not antialias, in the order of docs/tradeoff.md: those that mean anything
/// for this soup, with the settings that change something. `site` is where a plan shades it when
/// nobody asks for another; `visible_pixels` are count_visible_pixels() of the views, by which the
/// triangle budget chooses.
std::vector<Knob> drawing_knobs(const TriangleSoup& soup, ShadingSite site,
                                std::span<const std::uint64_t> visible_pixels);

/// Knob::key of supersampling.
inline constexpr const char* supersampling_key = "supersampling";

/// Those that decide how many samples a pixel has, and where: resolution scale, supersampling up to
/// `most_samples` an axis, alpha to coverage of as many samples as the device multisamples with
/// (DeviceLimits::sample_counts).
std::vector<Knob> antialiasing_knobs(int most_samples, std::span<const int> sample_counts);

/// How many settings each knob has: what the experiment counts.
std::vector<int> setting_counts(const std::vector<Knob>& knobs);

/// The preset of a configuration, without a promise.
RenderPreset preset_of(const std::vector<Knob>& knobs, const Configuration& configuration);

/// The network that the oracle is to emulate for a configuration; exact where it need not.
MlpPrecision emulated_precision(const std::vector<Knob>& knobs, const Configuration& configuration);

/// The settings that are not at their defaults, in words, "level 2, features as bytes";
/// "defaults" where there are none.
std::string describe(const std::vector<Knob>& knobs, const Configuration& configuration);

}  // namespace tureen::tradeoff
