// The edits and quality settings that a study of a soup varies: their values, and the effect of
// each on the soup's data or its sampling. The experiment (jobs/tradeoff/experiment.hpp) uses only
// their numbers.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "jobs/tradeoff/experiment.hpp"
#include "scene/edit/edits.hpp"
#include "scene/quality.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen::tradeoff {

/// The soup's edits and sampling quality for chosen values.
struct Applied {
  Edits edits;
  Quality quality;
};

struct SettingValue {
  std::string value;  // name for programs: "3", "base"
  std::string words;  // description: "lattice level 3", "base colour"
  std::function<void(Applied&)> apply;
};

/// An edit or a quality setting.
struct QualitySetting {
  std::string key;                   // name for programs: "lattice_level"
  std::string title;                 // description: "lattice level"
  std::vector<SettingValue> values;  // the default first; its apply changes nothing
};

/// The edits, in the order of docs/tradeoff.md: those that apply to this
/// soup, with the values that change it. `visible_pixels` is the result of count_visible_pixels()
/// for the views; the triangle budget uses it.
std::vector<QualitySetting> drawing_settings(const TriangleSoup& soup,
                                             std::span<const std::uint64_t> visible_pixels);

/// The quality settings: resolution scale, and supersampling up to
/// `max_samples` an axis.
std::vector<QualitySetting> antialiasing_settings(int max_samples);

/// The number of values of each setting, for the experiment.
std::vector<int> value_counts(const std::vector<QualitySetting>& settings);

Applied applied_by(const std::vector<QualitySetting>& settings, const Configuration& configuration);

/// The settings that differ from their defaults, "lattice level 2, base colour", or "defaults".
std::string describe(const std::vector<QualitySetting>& settings,
                     const Configuration& configuration);

}  // namespace tureen::tradeoff
