#include "cli/tradeoff_import.hpp"

#include <algorithm>
#include <filesystem>
#include <iterator>

#include "cli/interrupt.hpp"
#include "cli/output_argument.hpp"
#include "cli/tradeoff_plots.hpp"
#include "cli/tradeoff_reading.hpp"
#include "cli/tradeoff_scenes.hpp"
#include "cli/tradeoff_scenes_page.hpp"
#include "cli/tradeoff_scenes_report.hpp"
#include "cli/version.hpp"
#include "formats/existing_path.hpp"
#include "formats/output.hpp"
#include "soup/error.hpp"

namespace tureen::cli {

namespace {

namespace fs = std::filesystem;

std::vector<TradeoffRun> read_runs(const std::vector<std::string>& files) {
  std::vector<TradeoffRun> runs;
  for (const std::string& file : files) {
    throw_if_interrupted();
    require_there(file);
    Input input = Input::open(file);
    runs.push_back({file, read_tradeoff(input)});
  }
  return runs;
}

void write_files(const fs::path& folder, TradeoffScenes& scenes) {
  make_folder(folder);
  std::vector<Figure> figures = means_plots(scenes);
  const auto count = std::ptrdiff_t(figures.size());
  std::ranges::move(scene_plots(scenes), std::back_inserter(figures));
  std::vector<DrawnFigure> means, of_scenes;
  if (const auto drawn = write_figures(figures, folder)) {
    means.assign(drawn->begin(), drawn->begin() + count);
    of_scenes.assign(drawn->begin() + count, drawn->end());
    scenes.output = files_of(*drawn);
  } else {
    scenes.notes.emplace_back(gnuplot_missing);
  }
  const auto file = [&](const char* name) {
    scenes.output.push_back((folder / name).string());
    return folder / name;
  };
  write_file(file("scenes.html"), tradeoff_scenes_page(scenes, means, of_scenes));
  write_file(file("scenes.csv"), to_csv(scenes));
  const fs::path json = file("scenes.json");
  write_file(json, json_text(to_json(scenes)));
}

}  // namespace

ExitCode import_tradeoffs(const TradeoffImport& import) {
  if (import.files.size() < 2)
    throw UsageError("--import wants two results or more: a scene by itself has no mean");
  if (!import.folder.empty()) {
    for (const std::string& file : import.files)
      require_not_input(fs::path(import.folder) / "scenes.json", file);
    require_writable_folder(import.folder);
  }
  TradeoffScenes scenes = join(read_runs(import.files));
  scenes.date = utc_now();
  scenes.program = {program_version(), program_commit(), import.arguments};
  if (!import.folder.empty()) write_files(import.folder, scenes);

  for (std::size_t r = 0; r < scenes.runs.size(); ++r) {
    const TradeoffReport& report = scenes.runs[r].report;
    say(scenes.labels[r] + ": " + counted(report.scene.triangles) + " triangles, " +
        report.device.renderer + ", " + report.date);
  }
  say_list("Notes:", scenes.notes);
  say_tables(scenes);
  for (const std::string& path : scenes.output) say("wrote " + path);
  if (import.json) print_json(to_json(scenes));
  return ExitCode::done;
}

}  // namespace tureen::cli
