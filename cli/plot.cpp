// `tureen plot`: training logs as a picture.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include "cli/commands.hpp"
#include "cli/output_argument.hpp"
#include "cli/report.hpp"
#include "cli/training_plot.hpp"
#include "formats/extension.hpp"
#include "formats/output.hpp"
#include "soup/error.hpp"

namespace tureen::cli {

namespace {

namespace fs = std::filesystem;

struct Options {
  std::vector<std::string> logs;
  std::vector<std::string> labels;
  std::string output = "training.svg";
  bool json = false;
};

/// Names that tell the logs apart: the file's, or, where those are all the same, their folders'.
std::vector<std::string> default_labels(const std::vector<std::string>& logs) {
  std::vector<std::string> files, folders;
  for (const std::string& log : logs) {
    const fs::path path = fs::absolute(log).lexically_normal();
    files.push_back(path.stem().string());
    folders.push_back(path.parent_path().filename().string());
  }
  const bool same = logs.size() > 1 && std::equal(files.begin() + 1, files.end(), files.begin());
  return same ? folders : files;
}

std::vector<TrainingRun> read_runs(const Options& options) {
  const std::vector<std::string> names =
      options.labels.empty() ? default_labels(options.logs) : options.labels;
  std::vector<TrainingRun> runs;
  for (std::size_t i = 0; i < options.logs.size(); ++i) {
    runs.push_back({names[i], read_training_log(options.logs[i])});
    if (runs.back().records.empty())
      throw InputError({options.logs[i], {}, {}}, "it holds no record yet");
  }
  return runs;
}

/// The last held-out PSNR of a run.
std::optional<double> last_test_psnr(const TrainingRun& run) {
  for (auto record = run.records.rbegin(); record != run.records.rend(); ++record)
    if (record->test_psnr_db) return record->test_psnr_db;
  return std::nullopt;
}

Json report(const Options& options, const std::vector<TrainingRun>& runs) {
  Json list = Json::array();
  for (const TrainingRun& run : runs) {
    Json entry{{"name", run.name},
               {"records", run.records.size()},
               {"steps", run.records.back().step},
               {"seconds", run.records.back().seconds}};
    if (const std::optional<double> psnr = last_test_psnr(run)) entry["test_psnr_db"] = *psnr;
    list.push_back(entry);
  }
  return {{"runs", list}, {"output", {options.output}}};
}

ExitCode plot(const Options& options) {
  if (extension_of(options.output) != ".svg")
    throw UsageError("'" + options.output + "' does not end in .svg; plots are written as SVG");
  if (!options.labels.empty() && options.labels.size() != options.logs.size())
    throw UsageError(fmt::format("{} labels for {} logs; give one for each, in their order",
                                 options.labels.size(), options.logs.size()));
  require_writable_file(options.output);
  const std::vector<TrainingRun> runs = read_runs(options);
  Output output(options.output);
  output.write(training_plot(runs));
  output.commit();
  for (const TrainingRun& run : runs) {
    const std::optional<double> psnr = last_test_psnr(run);
    say(fmt::format("{}: {} steps in {:.0f} s{}", run.name, counted(run.records.back().step),
                    run.records.back().seconds,
                    psnr ? fmt::format(", {:.2f} dB on held-out views", *psnr) : ""));
  }
  say("wrote " + options.output);
  if (options.json) print_json(report(options, runs));
  return ExitCode::done;
}

}  // namespace

void add_plot(CLI::App& program, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand("plot", "Loss and PSNR of training runs");
  command->footer(R"(Draws the logs that training writes: the loss against steps, the PSNR against
time. Several logs share the axes.

Examples:
  tureen plot lego.jsonl -o lego.svg
  tureen plot ours.jsonl compat.jsonl --label ours --label published -o both.svg

Exit codes: 0 done, 2 wrong usage, 3 a log cannot be read, 5 the plot cannot be written.)");
  command->add_option("LOG", options->logs, "logs of training, JSON lines")
      ->required()
      ->type_name("");
  command->add_option("-o,--output", options->output, "the plot, training.svg by default")
      ->option_text("OUT.svg");
  command
      ->add_option("--label", options->labels,
                   "the name of a log in the legend, once for each log in their order; by default "
                   "its file's name, or its folder's where the files have the same")
      ->option_text("NAME")
      ->expected(1)
      ->take_all();
  command->add_flag("--json", options->json, "what was drawn as JSON on standard output");
  command->callback([options, &action] { action = [options] { return plot(*options); }; });
}

}  // namespace tureen::cli
