// What `tureen tradeoff` measures, by the options of its command line.
#pragma once

#include <string>
#include <vector>

#include "cli/options/dataset_argument.hpp"
#include "cli/options/scene_argument.hpp"
#include "cli/tradeoff/tradeoff_tables.hpp"
#include "jobs/tradeoff/pareto.hpp"
#include "jobs/tradeoff/reference.hpp"
#include "runtime/gl/context.hpp"

namespace tureen::cli {

/// How much is measured, where nothing more precise is asked for.
enum class Effort { quick, normal, full };

struct TradeoffOptions {
  SceneArgument scene;
  DatasetArgument dataset;  // no path: no E_model
  gl::Backend backend = gl::Backend::automatic;
  Effort effort = Effort::normal;
  std::string size;
  std::vector<std::string> cameras;  // empty: by the effort
  int rounds = 0, photographs = 0;   // 0: by the effort
  int combinations = -1;             // the same
  tradeoff::Samples samples = tradeoff::Samples::device;
  tradeoff::Limits limits;
  bool with_flip = true;
  bool processor_time = false;
  std::vector<std::string> arguments;  // of the program, as typed
};

/// Throws UsageError for what can be known to be wrong before anything is read.
void check(const TradeoffOptions& options);

/// Measures the scene, whose primitives are a TriangleSoup, with progress on the terminal, and
/// chooses. Throws what reading a dataset and what drawing throw, and Interrupted.
TradeoffReport measure_tradeoff(const TradeoffOptions& options, const Scene& scene);

}  // namespace tureen::cli
