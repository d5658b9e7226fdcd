// The results of a study of a scene: every configuration with its time and its error, in panels,
// and the Pareto front. Plain data and arithmetic, without drawing.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "image/render_error.hpp"
#include "jobs/timing/frame_statistics.hpp"
#include "jobs/tradeoff/pareto.hpp"
#include "jobs/tradeoff/settings.hpp"

namespace tureen::tradeoff {

/// Error against References::exact.
struct ExactError {
  double psnr_db = 0;
  double coverage_mismatch = 0;
};

/// The error of a configuration against photographs.
struct ModelError {
  double psnr_db = 0;  // mean of the views' PSNR, as in eval
  double ssim = 0;     // border `valid`
  double flip = 0;     // 0 if not computed
};

/// The method of drawing: our plan, our plan without specialisations (--no-specialise), or the
/// baseline.
enum class Factor { specialised, generic, baseline };

/// Names of the methods in output files, in the order of the enumeration.
inline constexpr std::array<const char*, 3> factor_names{"tureen", "tureen --no-specialise",
                                                         "published"};
const char* name_of(Factor factor);

/// One measured configuration.
struct Outcome {
  Configuration configuration;  // values of the panel's settings
  std::string name;             // description: "lattice level 2"
  Applied applied;
  Factor factor = Factor::specialised;
  /// In milliseconds, except the spread, a fraction (FrameStatistics::spread).
  FrameStatistics ms;
  double device_mib = 0;            // the soup's buffers and textures, and the targets of a view
  RenderError error;                // against References::judge
  std::optional<ExactError> exact;  // only in the drawing panel
  std::optional<ModelError> model;  // only with photographs
  bool stable = true;               // whether the warm-up was stable before timing

  int departures() const { return tradeoff::departures(configuration); }
};

/// A configuration that was not measured.
struct SkippedOutcome {
  std::string name;
  std::string reason;
};

/// The effect of one setting over its values.
struct SettingRange {
  std::size_t setting = 0;
  double time_ratio = 1;  // the slowest over the fastest
  double psnr_db = 0;     // the best minus the worst

  /// More than 5 % of time and more than 0.5 dB. A setting that affects only one of them is no
  /// trade-off and needs no experiment.
  bool matters() const { return time_ratio > 1.05 && psnr_db > 0.5; }
};

/// Outcomes with a common reference. The drawing panel has the edits, the antialiasing panel the
/// quality settings.
struct Panel {
  std::vector<QualitySetting> settings;
  std::vector<Outcome> outcomes;  // the defaults first
  std::vector<SettingRange> ranges;
  std::vector<SkippedOutcome> skipped;
  std::vector<std::string> notes;
  double aa_spread = 0;            // largest of all groups
  std::vector<std::size_t> front;  // indices of outcomes, fastest first; from candidates()

  /// R1: the error of the reference's images after rounding to 8 bits per channel.
  RenderError ideal;
};

/// Whether the error of an outcome is meaningful. False if the outcome has as many samples as the
/// antialiasing reference (antialiased_samples): only its time is then used.
bool is_judged(const Outcome& outcome);

/// Sentences on limits of the validity of an outcome's time or error.
std::vector<std::string> warnings_about(const Outcome& outcome);

/// Time and error of the outcomes that may be on the front; `index` has their indices in
/// Panel::outcomes.
struct Candidates {
  std::vector<Point> points;
  std::vector<std::size_t> index;
};
Candidates candidates(const Panel& panel);

/// Computes the range of every setting from the outcomes that change at most this setting, with
/// specialisations. Ignores errors that have no meaning.
void find_ranges(Panel& panel);

/// The combinations of the settings that matter, at most `most`, of at most four settings. They are
/// ranked by the product of their effects on time and error; a note counts those that are left out.
std::vector<Configuration> combinations_of(Panel& panel, std::size_t most);

/// Computes the front from the candidates.
void find_front(Panel& panel);

bool is_on_front(const Panel& panel, std::size_t outcome);

/// The outcome of the same configuration without specialisations, or null. Null for the baseline.
const Outcome* generic_of(const Panel& panel, const Outcome& outcome);

struct Study {
  Panel drawing;
  Panel antialiasing;
  /// Index of the baseline in the drawing panel (R0), if it can draw this soup.
  std::optional<std::size_t> baseline;
  /// The error of the device's subpixel grid alone: the reference at the device's sample points
  /// against the exact one. It is independent of all settings.
  RenderError grid;
  /// The index of the chosen outcome in the drawing panel. run_study() leaves it empty, since the
  /// caller sets the limits.
  std::optional<std::size_t> choice;
};

/// A warning if two timings of one configuration differ by more than
/// BenchmarkOptions::stable_within. The choice is then partly random. `aa_spread` is a fraction.
std::optional<std::string> spread_warning(double aa_spread);

}  // namespace tureen::tradeoff
