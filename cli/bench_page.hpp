// A result of `tureen bench` as one HTML page: what was measured, on what, how, and the plots.
#pragma once

#include <string>
#include <vector>

#include "cli/bench_comparison.hpp"
#include "cli/bench_result.hpp"
#include "cli/figures.hpp"

namespace tureen::cli {

struct BenchPage {
  struct Picture {
    std::vector<std::byte> png;
    std::string caption;
  };
  std::vector<DrawnFigure> figures;
  std::vector<Picture> pictures;  // of frames that were timed
  /// Against which file, and what came out; null where nothing was compared.
  std::string compared_with;
  const BenchComparison* comparison = nullptr;
  std::string missing;  // why there are no plots; empty where there are
};

/// The page, complete (cli/html_page.hpp).
std::string bench_page(const BenchResult& result, const BenchPage& page);

}  // namespace tureen::cli
