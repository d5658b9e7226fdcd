// One panel over several scenes, of runs of `tureen tradeoff`: what a way to draw costs and gains
// on the whole, whatever a single scene has to say: the means of the logarithms of time and of the
// squared error (docs/tradeoff.md). Plain arithmetic.
//
// A way to draw is a method (Outcome) and the settings that are asked for. Scenes differ in their
// defaults: one is shaded once a pixel, another once a fragment. So "once a fragment" is in the
// first a departure and in the second its defaults, and both have it; only who lacks the knob or
// the setting, or did not measure it, has not.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "cli/tradeoff_report.hpp"

namespace tureen::cli {

/// A run of one scene, as it was imported.
struct TradeoffRun {
  std::string file;  // that it was read from
  TradeoffReport report;
};

struct LeftOut {
  std::string name;  // of the way to draw, in words
  Method method = Method::specialised;
  std::vector<std::size_t> lacking;  // the runs that have it not; at least one
};

struct ScenesPanel {
  /// An outcome for each way to draw that all runs have, the defaults first. What is filled:
  ///  - knobs: those of all runs; the first setting, "", is each scene's own default;
  ///  - configuration, name, method;
  ///  - ms.min_of_medians, median and p95: geometric means of the runs' own, unless it is emulated;
  ///  - error.psnr_db: the mean of decibels, which is the PSNR of the geometric mean of the squared
  ///    errors, each at least 1e-10 (100 dB); error.view_psnr_db: of the scenes;
  ///    error.worst_psnr_db and error.coverage_mismatch: of the scene that is worst;
  ///  - ideal.psnr_db: as error.psnr_db;
  ///  - aa_spread: by how much geometric means differ by chance at most, as (1 + 2 aa_spread) is
  ///    the geometric mean of the runs' own;
  ///  - front and hypervolume, of these.
  Panel means;
  /// members[i][r] is the outcome of run r that is part of means.outcomes[i].
  std::vector<std::vector<std::size_t>> members;
  std::vector<LeftOut> left_out;
};

struct TradeoffScenes {
  std::string date;      // of the import, as TradeoffReport::date
  BenchProgram program;  // that imported
  std::vector<TradeoffRun> runs;
  std::vector<std::string>
      labels;  // of the runs: the scenes' names, or files where two are the same
  ScenesPanel drawing, antialiasing;
  std::vector<std::string> notes;   // on what the runs do not have in common, or do not tell
  std::vector<std::string> output;  // files that were written
};

/// Joins at least two runs, in their order. Throws InputError with the file where a scene is there
/// twice, the same in name, path, triangles and appearance, or where the errors are against another
/// reference (TradeoffReport::samples) than those of the first run.
TradeoffScenes join(std::vector<TradeoffRun> runs);

/// That of a run, of which `panel`, drawing or antialiasing of `scenes` themselves, was joined.
const Panel& own_panel(const TradeoffScenes& scenes, const ScenesPanel& panel, std::size_t run);

/// The time of an outcome relative to that of the panel's defaults: what is left when one machine
/// is twice as fast as another. Of means the geometric mean of the runs' own ratios. Says nothing
/// of emulated ones, which have no time.
double time_ratio(const Panel& panel, std::size_t outcome);

/// Drawing's published pipeline (R0), where all runs have it.
const Outcome* published_of(const ScenesPanel& panel);

}  // namespace tureen::cli
