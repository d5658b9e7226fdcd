// The edits and quality settings that a study of a scene varies, as a table of values, and the
// configurations that it measures.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "scene/edit/edits.hpp"
#include "scene/edit/splat_edits.hpp"
#include "scene/quality.hpp"
#include "scene/scene.hpp"
#include "scene/splats.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen::tradeoff {

/// The edits and the quality of a scene for chosen values.
struct Applied {
  Edits edits = {};             // of a soup
  SplatEdits splat_edits = {};  // of splats
  Quality quality = {};
};

/// Whether the data change.
bool has_edits(const Applied& applied);
/// "12 of 40 triangles, lattice level at most 3"; "none".
std::string describe_edits(const Applied& applied);
/// The scene, which has one layer, with the edits applied. Its quality stays. `progress` as for
/// edited() of a soup.
Scene edited(Scene scene, const Applied& applied, const std::function<void(double)>& progress = {});

struct SettingValue {
  std::string value = {};  // name for programs: "3", "base"
  std::string words = {};  // description: "lattice level 3", "base colour"
  /// What differs from the defaults; nothing for the default.
  Applied change = {};
};

/// An edit or a quality setting.
struct QualitySetting {
  std::string key;                   // name for programs: "lattice_level"
  std::string title;                 // description: "lattice level"
  std::vector<SettingValue> values;  // the default first
};

/// The settings that depend on the scene, in the order of docs/tradeoff.md: the edits that apply to
/// this soup, with the values that change it. `visible_pixels` is the result of
/// count_visible_pixels() for the views; the triangle budget uses it.
std::vector<QualitySetting> scene_settings(const TriangleSoup& soup,
                                           std::span<const std::uint64_t> visible_pixels);

/// Those of splats: their order, which is a quality setting, and two edits: their number, and for
/// windows opaque triangles. `weights`: those of splat_use(); empty: the number is fixed.
std::vector<QualitySetting> scene_settings(const Splats& splats,
                                           std::span<const std::uint64_t> weights);

/// The quality settings: resolution scale, supersampling up to `max_samples` per axis, and with
/// splats their order.
std::vector<QualitySetting> antialiasing_settings(int max_samples, bool has_splats);

/// The value index of each setting; 0 is the default.
using Configuration = std::vector<int>;

/// Number of settings that differ from their default.
int departures(const Configuration& configuration);

Applied applied_by(const std::vector<QualitySetting>& settings, const Configuration& configuration);
/// Its quality alone; the edits may be an array as long as the scene.
Quality quality_of(const std::vector<QualitySetting>& settings, const Configuration& configuration);

/// The settings that differ from their defaults, "lattice level 2, base colour", or "defaults".
std::string describe(const std::vector<QualitySetting>& settings,
                     const Configuration& configuration);

/// The defaults, then every other value of every setting alone.
std::vector<Configuration> single_changes(const std::vector<QualitySetting>& settings);

/// All combinations of at least two changes of the settings with these indices, except those whose
/// Quality has a defect.
std::vector<Configuration> combinations(const std::vector<QualitySetting>& settings,
                                        std::span<const std::size_t> varied);

}  // namespace tureen::tradeoff
