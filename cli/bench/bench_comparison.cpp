#include "cli/bench/bench_comparison.hpp"

#include <fmt/format.h>

#include "cli/measuring/bench_words.hpp"
#include "cli/table.hpp"
#include "jobs/bench/comparison_json.hpp"

namespace tureen::cli {

std::vector<std::string> comparison_lines(const BenchComparison& comparison) {
  std::vector<std::string> lines;
  if (!comparison.ratios.empty()) {
    Table table(
        {"configuration", "<cameras", "<size", "ms then", "ms now", "ratio", "<", "spread", "<"});
    for (const BenchRatio& ratio : comparison.ratios)
      table.row({ratio.configuration, ratio.camera_set, ratio.size, ms_text(ratio.then_ms),
                 ms_text(ratio.now_ms), fmt::format("{:.3f}", ratio.ratio),
                 verdict_text(ratio.verdict, ratio.rounds),
                 ratio.spread ? fmt::format("{:.1f} %", 100 * *ratio.spread) : not_known,
                 ratio.same_pixels ? "" : "different image"});
    lines = table.lines();
  }
  for (std::string& line : results::circumstances(comparison)) lines.push_back(std::move(line));
  for (std::string& line : results::unmatched_lines(comparison)) lines.push_back(std::move(line));
  return lines;
}

}  // namespace tureen::cli
