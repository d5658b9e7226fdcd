// The knobs that a soup has: what each can be set to, and what that changes in its data or in how
// finely it is drawn. The experiment (runtime/tradeoff/experiment.hpp) counts them, this says what
// they mean.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "runtime/tradeoff/experiment.hpp"
#include "soup/edits.hpp"
#include "soup/quality.hpp"
#include "soup/triangle_soup.hpp"

namespace tureen::tradeoff {

/// What settings stand for: the soup with its edits, drawn like this.
struct Applied {
  Edits edits;
  Quality quality;
};

struct Setting {
  std::string value;  // for programs: "3", "base"
  std::string words;  // for people: "lattice level 3", "base colour"
  std::function<void(Applied&)> apply;
};

struct Knob {
  std::string key;                // for programs: "lattice_level"
  std::string title;              // for people: "lattice level"
  std::vector<Setting> settings;  // the default first, whose apply changes nothing
};

/// The knobs that do not antialias, in the order of docs/tradeoff.md: those that mean anything
/// for this soup, with the settings that change something. `visible_pixels` are
/// count_visible_pixels() of the views, by which the triangle budget chooses.
std::vector<Knob> drawing_knobs(const TriangleSoup& soup,
                                std::span<const std::uint64_t> visible_pixels);

/// Knob::key of supersampling.
inline constexpr const char* supersampling_key = "supersampling";

/// Those that decide how many samples a pixel has, and where: resolution scale, supersampling up to
/// `most_samples` an axis.
std::vector<Knob> antialiasing_knobs(int most_samples);

/// How many settings each knob has: what the experiment counts.
std::vector<int> setting_counts(const std::vector<Knob>& knobs);

Applied applied_by(const std::vector<Knob>& knobs, const Configuration& configuration);

/// The settings that are not at their defaults, in words, "lattice level 2, base colour";
/// "defaults" where there are none.
std::string describe(const std::vector<Knob>& knobs, const Configuration& configuration);

}  // namespace tureen::tradeoff
