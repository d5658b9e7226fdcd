// What a study of a scene finds: every configuration with its time and its error, panel by panel,
// and which of them are worth having. Plain data and arithmetic: nothing here draws.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "image/render_error.hpp"
#include "jobs/timing/frame_statistics.hpp"
#include "jobs/tradeoff/pareto.hpp"
#include "jobs/tradeoff/quality_settings.hpp"

namespace tureen::tradeoff {

/// Against References::exact.
struct ExactError {
  double psnr_db = 0;
  double coverage_mismatch = 0;
};

/// How an outcome was drawn: by our plan, by our plan without specialisations (--no-specialise), or
/// by the published pipeline.
enum class Method { specialised, generic, published };

/// Of methods in their order, as files have them.
inline constexpr std::array<const char*, 3> method_names{"tureen", "tureen --no-specialise",
                                                         "published"};
const char* name_of(Method method);

/// One way to draw, with the numbers it came to.
struct Outcome {
  Configuration configuration;  // of the panel's settings
  std::string name;             // in words: "lattice level 2"
  Applied applied;
  Method method = Method::specialised;
  /// In milliseconds, except the spread, a fraction (FrameStatistics::spread).
  FrameStatistics ms;
  double device_mib = 0;            // the soup's buffers and textures, and the targets of a view
  RenderError error;                // against References::judge
  std::optional<ExactError> exact;  // drawing settings alone
  bool stable = true;               // the warm-up settled before timing began

  int departures() const { return tradeoff::departures(configuration); }
};

/// A configuration that was not measured.
struct SkippedOutcome {
  std::string name;
  std::string reason;
};

/// Outcomes with one reference: of drawing settings, or of antialiasing ones.
struct Panel {
  std::vector<QualitySetting> settings;
  std::vector<Outcome> outcomes;  // the defaults first
  std::vector<SettingRange> ranges;
  std::vector<SkippedOutcome> skipped;
  std::vector<std::string> notes;
  double aa_spread = 0;            // the largest of the groups
  std::vector<std::size_t> front;  // fastest first; of candidates()
  double hypervolume = 0;          // decades times decibels

  /// The reference's own pictures in 8 bits a channel: the best that a screen can show (R1).
  RenderError ideal;
};

/// Whether the error of an outcome depends on its settings. Supersampling at the antialiasing
/// reference's own samples (antialiased_samples) is measured for its time.
bool is_judged(const Outcome& outcome);

/// Sentences on why time or error of an outcome mean less than they seem.
std::vector<std::string> warnings_about(const Outcome& outcome);

/// Time and error of the outcomes that may be on the front; `index` has their indices in
/// Panel::outcomes.
struct Candidates {
  std::vector<Point> points;
  std::vector<std::size_t> index;
};
Candidates candidates(const Panel& panel);

/// Sets front and hypervolume by the candidates.
void find_front(Panel& panel);

bool is_on_front(const Panel& panel, std::size_t outcome);

/// The outcome of the same configuration without specialisations; null where there is
/// none, and of the published pipeline.
const Outcome* generic_of(const Panel& panel, const Outcome& outcome);

struct Study {
  Panel drawing;
  Panel antialiasing;
  /// The published pipeline as an outcome of the drawing panel (R0), where it can draw this soup.
  std::optional<std::size_t> published;
  /// The error of the device's subpixel grid alone: the reference at the device's sample points
  /// against the exact one. No setting changes it.
  RenderError grid;
  /// The index of the chosen outcome of the drawing panel. run_study() leaves it empty: the limits
  /// are the caller's.
  std::optional<std::size_t> choice;
};

/// A warning where one configuration differs from itself by more than
/// BenchmarkOptions::stable_within: the choice of the cheapest is then partly chance. `aa_spread`
/// is a fraction.
std::optional<std::string> spread_warning(double aa_spread);

}  // namespace tureen::tradeoff
