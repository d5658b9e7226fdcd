// Which views `tureen bench` measures with: sets of cameras, at sizes.
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
  std::vector<std::string> notes;  // on what cameras lacked
};

/// DATASET, --cameras, --size (also --sizes) and --sweep.
void add_bench_view_options(Command& command, BenchViewOptions& options);

/// Whatever is wrong with them that can be told before a scene is read: throws UsageError.
void check(const BenchViewOptions& options);

/// Every set at every size that it can have: full, half and quarter only of recorded cameras.
/// Throws UsageError and InputError; Interrupted while a dataset is read.
BenchViewList bench_views(const BenchViewOptions& options, const Scene& scene,
                          const std::string& scene_path);

}  // namespace tureen::cli
