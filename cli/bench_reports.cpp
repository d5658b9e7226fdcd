#include "cli/bench_reports.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "cli/bench_comparison.hpp"
#include "cli/bench_csv.hpp"
#include "cli/bench_markdown.hpp"
#include "cli/bench_page.hpp"
#include "cli/bench_plots.hpp"
#include "cli/bench_words.hpp"
#include "cli/number_range.hpp"
#include "cli/output_argument.hpp"
#include "formats/existing_path.hpp"
#include "formats/input.hpp"
#include "formats/output.hpp"
#include "soup/error.hpp"

namespace tureen::cli {

namespace {

namespace fs = std::filesystem;

constexpr const char* json_name = "bench.json";
constexpr const char* csv_name = "bench.csv";
constexpr const char* markdown_name = "bench.md";
constexpr const char* page_name = "bench.html";

/// Larger pictures would make a page that nobody wants to open.
constexpr std::uintmax_t most_picture_bytes = 1u << 20;
constexpr std::size_t most_pictures = 8;

void write_and_say(const fs::path& path, const std::string& text) {
  write_file(path, text);
  say("wrote " + path.string());
}

std::vector<std::byte> bytes_of(const fs::path& path) {
  Input input = Input::open(path);
  return input.read_rest();
}

/// Pictures of timed frames that lie where the result says, the first ones of moderate size.
std::vector<BenchPage::Picture> pictures_of(const BenchResult& result) {
  std::vector<BenchPage::Picture> pictures;
  for (const BenchMeasurement& m : result.measurements) {
    std::error_code error;
    if (!m.picture || pictures.size() == most_pictures) continue;
    const std::uintmax_t size = fs::file_size(*m.picture, error);
    if (error || size > most_picture_bytes) continue;
    pictures.push_back(
        {bytes_of(*m.picture),
         fmt::format("{}, {} at {}x{}: the last frame that was timed, pixels {}", m.configuration,
                     m.camera_set, m.width, m.height, m.pixels_hash)});
  }
  return pictures;
}

struct Plots {
  std::vector<DrawnFigure> drawn;
  std::string missing;  // why there are none; empty where there are
};

/// Draws all plots into `folder`, and says so, or why not.
Plots write_plots(const BenchResult& result, const fs::path& folder) {
  const std::vector<Figure> figures = bench_plots(result);
  if (figures.empty()) {
    Plots none{{},
               "no plots: no cameras have two sizes or two views, and there is one configuration"};
    say(none.missing);
    return none;
  }
  auto drawn = write_figures(figures, folder);
  say(drawn ? fmt::format("wrote {} to {}", count_text(int(drawn->size()), "plot"), folder.string())
            : gnuplot_missing);
  if (!drawn) return {{}, gnuplot_missing};
  return {std::move(*drawn), {}};
}

/// But for plots and pictures.
std::vector<fs::path> files_of(const BenchReportOptions& options) {
  std::vector<fs::path> files;
  if (!options.folder.empty())
    for (const char* name : {json_name, csv_name, markdown_name, page_name})
      files.push_back(fs::path(options.folder) / name);
  if (!options.csv.empty()) files.push_back(options.csv);
  return files;
}

/// What --fail-slower cannot say of what has passed.
void say_limits(const BenchComparison& comparison, double percent) {
  const auto coarse = [&](const BenchRatio& ratio) {
    return ratio.spread && 2 * *ratio.spread > percent / 100;
  };
  const auto count = std::count_if(comparison.ratios.begin(), comparison.ratios.end(), coarse);
  if (count > 0)
    say(fmt::format(
        "--fail-slower: of {} of {} twice the spread is more than {:g} %, and only what "
        "is slower by more than that would have been noticed",
        count, comparison.ratios.size(), percent));
  if (!comparison.unmatched.empty())
    say(fmt::format("--fail-slower: {} that only one of the two measured {} not judged",
                    count_text(int(comparison.unmatched.size()), "row"),
                    comparison.unmatched.size() == 1 ? "is" : "are"));
}

void say_comparison(const BenchComparison& comparison, const std::string& file) {
  say_list("against " + file + ":", comparison_lines(comparison));
  if (comparison.ratios.empty()) say("nothing can be compared");
}

}  // namespace

void add_bench_report_options(CLI::App& command, BenchReportOptions& options) {
  command
      .add_option(
          "-o,--output", options.folder,
          "a folder for bench.json, bench.csv, bench.md, bench.html and the plots as SVG and PNG")
      ->option_text("FOLDER");
  command.add_option("--csv", options.csv, "the table as CSV")->option_text("FILE");
  command
      .add_option("--plots", options.plots,
                  "a folder for the plots alone; gnuplot draws them, where it is installed")
      ->option_text("FOLDER");
  auto* against = command
                      .add_option("--against", options.against,
                                  "an earlier bench.json: says what became faster or slower, and "
                                  "what differs by more than twice the spread")
                      ->option_text("OLD.json");
  command
      .add_option("--fail-slower", options.fail_slower,
                  "exit code 1 where something is slower than before by more than so many percent "
                  "and by more than twice the spread")
      ->option_text("PERCENT")
      ->check(between(0.0, 1e4))
      ->needs(against);
  command.add_flag("--json", options.json, "the result as JSON on standard output");
}

std::optional<BenchResult> prepare_bench_reports(const BenchReportOptions& options,
                                                 std::vector<std::string> inputs) {
  if (!options.against.empty()) inputs.push_back(options.against);
  for (const fs::path& output : files_of(options))
    for (const std::string& input : inputs) require_not_input(output, input);
  std::optional<BenchResult> then;
  if (!options.against.empty()) {
    require_there(options.against);
    const std::vector<std::byte> bytes = bytes_of(options.against);
    then = bench_result_from_json(
        std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()), options.against);
    const auto few = [](const BenchMeasurement& m) { return m.frame_ms.rounds < least_rounds; };
    if (options.fail_slower &&
        std::any_of(then->measurements.begin(), then->measurements.end(), few))
      throw UsageError(
          fmt::format("--fail-slower wants {} rounds of {}, too", least_rounds, options.against),
          "measure it anew");
  }
  for (const std::string& each : {options.folder, options.plots}) {
    if (each.empty()) continue;
    make_folder(each);
    require_writable_folder(each);
  }
  for (const fs::path& file : files_of(options)) require_writable_file(file);
  return then;
}

ExitCode report_bench(const BenchReportOptions& options, const BenchResult& now,
                      const std::optional<BenchResult>& then) {
  std::optional<BenchComparison> comparison;
  if (then) comparison = compare_benches(now, *then);
  if (comparison) say_comparison(*comparison, options.against);
  Json told = to_json(now);
  if (comparison) told["comparison"] = to_json(*comparison, options.against);
  if (options.json) print_json(told);

  if (!options.csv.empty()) write_and_say(options.csv, bench_csv(now));
  if (!options.plots.empty()) write_plots(now, options.plots);
  if (!options.folder.empty()) {
    const fs::path folder = options.folder;
    write_and_say(folder / json_name, json_text(told));
    write_and_say(folder / csv_name, bench_csv(now));
    std::string markdown = bench_markdown(now);
    if (comparison) markdown += comparison_markdown(*comparison, options.against);
    write_and_say(folder / markdown_name, markdown);
    Plots plots = write_plots(now, folder);
    BenchPage page{.figures = std::move(plots.drawn),
                   .pictures = pictures_of(now),
                   .compared_with = options.against,
                   .comparison = comparison ? &*comparison : nullptr,
                   .missing = std::move(plots.missing)};
    write_and_say(folder / page_name, bench_page(now, page));
  }

  if (!options.fail_slower || !comparison) return ExitCode::done;
  const auto unknown =
      std::count_if(comparison->ratios.begin(), comparison->ratios.end(),
                    [](const BenchRatio& ratio) { return ratio.verdict == Verdict::unknown; });
  if (unknown > 0)
    say(
        fmt::format("--fail-slower cannot judge {} of {}, of fewer than {} rounds: --seconds gives "
                    "them more time",
                    unknown, comparison->ratios.size(), least_rounds));
  say_limits(*comparison, *options.fail_slower);
  const std::vector<BenchRatio> slower = slower_than(*comparison, *options.fail_slower);
  for (const BenchRatio& ratio : slower)
    say(fmt::format("slower than allowed: {}, {}, {}: {:.3f} times as long", ratio.configuration,
                    ratio.camera_set, ratio.size, ratio.ratio));
  // What nobody could judge has not passed.
  const bool judged = unknown == 0 && !comparison->ratios.empty();
  return judged && slower.empty() ? ExitCode::done : ExitCode::check_failed;
}

}  // namespace tureen::cli
