// The quality settings that a soup has: the values of each, and what these change in its data or in
// how finely it is drawn. The experiment (jobs/tradeoff/experiment.hpp) knows only their
// numbers.
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

/// The soup with these edits, drawn at this quality: the meaning of chosen values.
struct Applied {
  Edits edits;
  Quality quality;
};

struct SettingValue {
  std::string value;  // for programs: "3", "base"
  std::string words;  // for people: "lattice level 3", "base colour"
  std::function<void(Applied&)> apply;
};

struct QualitySetting {
  std::string key;                   // for programs: "lattice_level"
  std::string title;                 // for people: "lattice level"
  std::vector<SettingValue> values;  // the default first, whose apply changes nothing
};

/// The settings that do not antialias, in the order of docs/tradeoff.md: those that mean anything
/// for this soup, with the values that change something. `visible_pixels` are
/// count_visible_pixels() of the views, by which the triangle budget chooses.
std::vector<QualitySetting> drawing_settings(const TriangleSoup& soup,
                                             std::span<const std::uint64_t> visible_pixels);

/// Those that decide how many samples a pixel has, and where: resolution scale, supersampling up to
/// `max_samples` an axis.
std::vector<QualitySetting> antialiasing_settings(int max_samples);

/// How many values each setting has: what the experiment counts.
std::vector<int> value_counts(const std::vector<QualitySetting>& settings);

Applied applied_by(const std::vector<QualitySetting>& settings, const Configuration& configuration);

/// The settings that are not at their defaults, in words, "lattice level 2, base colour";
/// "defaults" where there are none.
std::string describe(const std::vector<QualitySetting>& settings,
                     const Configuration& configuration);

}  // namespace tureen::tradeoff
