// The views of `tureen bench`: sets of cameras at image sizes.
#pragma once

#include <string>
#include <vector>

#include "cli/options/arguments.hpp"
#include "jobs/bench/bench_result.hpp"
#include "scene/scene.hpp"

namespace tureen::cli {

/// As typed.
struct BenchViewOptions {
  std::string dataset;               // empty: none
  std::vector<std::string> cameras;  // "hemisphere:8", "orbit", "adversarial", "dataset", FILE
  std::vector<std::string> sizes;    // "1280x720", "full", "half", "quarter"
  bool sweep = false;
};

struct BenchViewList {
  std::vector<BenchViews> views;   // small images first; at least one
  std::vector<std::string> notes;  // on missing data in camera files
};

/// DATASET, --cameras, --size (also --sizes) and --sweep.
void add_bench_view_options(Command& command, BenchViewOptions& options);

/// Checks the options before a scene is read. Throws UsageError.
void check(const BenchViewOptions& options);

/// Every set at every size; full, half and quarter only for recorded cameras. Throws UsageError and
/// InputError, and Interrupted while it reads a dataset.
BenchViewList bench_views(const BenchViewOptions& options, const Scene& scene,
                          const std::string& scene_path);

}  // namespace tureen::cli
