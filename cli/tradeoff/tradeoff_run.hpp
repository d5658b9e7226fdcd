// Runs the measurements of `tureen tradeoff` with the options of its command line.
#pragma once

#include <string>
#include <vector>

#include "cli/options/dataset_argument.hpp"
#include "cli/options/scene_argument.hpp"
#include "cli/tradeoff/tradeoff_tables.hpp"
#include "jobs/tradeoff/pareto.hpp"
#include "jobs/tradeoff/references.hpp"
#include "runtime/gl/context.hpp"

namespace tureen::cli {

/// Selects the defaults of the options, and so the amount of measurements.
enum class Effort { quick, normal, full };

struct TradeoffOptions {
  SceneArgument scene;
  DatasetArgument dataset;  // no path: no E_model
  gl::Backend backend = gl::Backend::automatic;
  Effort effort = Effort::normal;
  std::string size;
  std::vector<std::string> cameras;  // empty: default of the effort
  int rounds = 0, photographs = 0;   // 0: default of the effort
  int combinations = -1;             // negative: default of the effort
  tradeoff::Samples samples = tradeoff::Samples::device;
  tradeoff::Limits limits;
  bool with_flip = true;
  bool processor_time = false;
  std::vector<std::string> arguments;  // of the program, as typed
};

/// Checks the options before anything is read. Throws UsageError.
void check(const TradeoffOptions& options);

/// Measures a scene with one layer, which is visible, and makes the choice. Prints
/// progress. Throws Interrupted, and the exceptions of reading a dataset and of drawing.
TradeoffReport measure_tradeoff(const TradeoffOptions& options, const Scene& scene);

}  // namespace tureen::cli
