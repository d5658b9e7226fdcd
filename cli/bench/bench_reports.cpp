#include "cli/bench/bench_reports.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/error.hpp"
#include "base/existing_path.hpp"
#include "base/input.hpp"
#include "base/output.hpp"
#include "cli/files/result_files.hpp"
#include "cli/measuring/bench_words.hpp"
#include "cli/options/output_argument.hpp"
#include "cli/report.hpp"
#include "cli/table.hpp"
#include "jobs/bench/comparison_json.hpp"

namespace tureen::cli {

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> files_of(const BenchReportOptions& options) {
  return options.folder.empty() ? std::vector<fs::path>() : result_files(options.folder, "bench");
}

/// Prints which slowdowns --fail-slower cannot detect.
void say_limits(const BenchComparison& comparison, double percent) {
  const auto coarse = [&](const BenchRatio& ratio) {
    return ratio.spread && 2 * *ratio.spread > percent / 100;
  };
  const auto count = std::count_if(comparison.ratios.begin(), comparison.ratios.end(), coarse);
  if (count > 0)
    say(
        fmt::format("--fail-slower: in {} of {} rows, twice the spread is above {:g} %; smaller "
                    "slowdowns there cannot be detected",
                    count, comparison.ratios.size(), percent));
  if (!comparison.unmatched.empty())
    say(fmt::format("--fail-slower: {} in one result only {} not checked",
                    count_text(int(comparison.unmatched.size()), "row"),
                    comparison.unmatched.size() == 1 ? "is" : "are"));
}

void say_comparison(const BenchComparison& comparison, const std::string& file) {
  say_list("Against " + file + ":", comparison_lines(comparison));
  if (comparison.ratios.empty()) say("no rows can be compared");
}

}  // namespace

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

void add_bench_report_options(Command& command, BenchReportOptions& options) {
  command.add_option("-o,--output FOLDER", options.folder,
                     "folder for report.html, bench.json and the images");
  const Option against = command.add_option(
      "--against OLD.json", options.against,
      "earlier bench.json to compare with; reports differences above twice the spread");
  command
      .add_option("--fail-slower PERCENT", options.fail_slower,
                  "exit with 1 if anything is slower than in --against by more than this "
                  "percentage and by more than twice the spread",
                  between(0.0, 1e4))
      .needs(against);
  command.add_flag("--json", options.json, "print the result as JSON to standard output");
}

std::optional<BenchResult> prepare_bench_reports(const BenchReportOptions& options,
                                                 std::vector<std::string> inputs) {
  if (!options.against.empty()) inputs.push_back(options.against);
  for (const fs::path& output : files_of(options))
    for (const std::string& input : inputs) require_not_input(output, input);
  std::optional<BenchResult> then;
  if (!options.against.empty()) {
    require_there(options.against);
    then =
        results::bench_result_from_json(Input::open(options.against).read_text(), options.against);
    const auto few = [](const BenchMeasurement& m) { return m.frame_ms.rounds < min_rounds; };
    if (options.fail_slower &&
        std::any_of(then->measurements.begin(), then->measurements.end(), few))
      throw UsageError(fmt::format("--fail-slower also needs at least {} rounds in {}", min_rounds,
                                   options.against),
                       "measure it again");
  }
  if (!options.folder.empty()) {
    make_folder(options.folder);
    require_writable_folder(options.folder);
    for (const fs::path& file : files_of(options)) require_writable_file(file);
  }
  return then;
}

ExitCode report_bench(const BenchReportOptions& options, const BenchResult& now,
                      const std::optional<BenchResult>& then) {
  std::optional<BenchComparison> comparison;
  if (then) comparison = compare_benches(now, *then);
  if (comparison) say_comparison(*comparison, options.against);
  Json told = results::to_json(now);
  if (comparison) told["comparison"] = results::to_json(*comparison, options.against);
  if (options.json) print_json(told);

  if (!options.folder.empty()) write_result(options.folder, "bench", json_text(told));
  for (const fs::path& file : files_of(options)) say("wrote " + file.string());

  if (!options.fail_slower || !comparison) return ExitCode::done;
  const auto unknown =
      std::count_if(comparison->ratios.begin(), comparison->ratios.end(),
                    [](const BenchRatio& ratio) { return ratio.verdict == Verdict::unknown; });
  if (unknown > 0)
    say(fmt::format(
        "--fail-slower cannot check {} of {} rows with fewer than {} rounds; increase --seconds",
        unknown, comparison->ratios.size(), min_rounds));
  say_limits(*comparison, *options.fail_slower);
  const std::vector<BenchRatio> slower = slower_than(*comparison, *options.fail_slower);
  for (const BenchRatio& ratio : slower)
    say(fmt::format("slower than --fail-slower allows: {}, {}, {}: {:.3f} times the earlier time",
                    ratio.configuration, ratio.camera_set, ratio.size, ratio.ratio));
  // The check also fails if a row has no verdict, or if there are no rows.
  const bool judged = unknown == 0 && !comparison->ratios.empty();
  return judged && slower.empty() ? ExitCode::done : ExitCode::check_failed;
}

}  // namespace tureen::cli
