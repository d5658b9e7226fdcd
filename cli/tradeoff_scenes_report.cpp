#include "cli/tradeoff_scenes_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "cli/provenance.hpp"

namespace tureen::cli {

namespace {

std::size_t worst_run(const Outcome& mean) {
  const std::vector<double>& of_scenes = mean.error.view_psnr_db;
  return std::size_t(std::min_element(of_scenes.begin(), of_scenes.end()) - of_scenes.begin());
}

Json run_json(const TradeoffScenes& scenes, std::size_t r) {
  const TradeoffReport& report = scenes.runs[r].report;
  return {{"label", scenes.labels[r]},
          {"file", scenes.runs[r].file},
          {"date", report.date},
          {"program", to_json(report.program)},
          {"scene", to_json(report.scene)},
          {"machine", to_json(report.machine)},
          {"device", to_json(report.device)},
          {"camera_set", report.camera_set},
          {"width", report.width},
          {"height", report.height},
          {"views", report.views},
          {"rounds", report.rounds},
          {"clock", report.clock}};
}

Json settings_json(const Panel& means, const Outcome& outcome) {
  Json json = Json::object();
  for (std::size_t i = 0; i < means.knobs.size(); ++i)
    if (const int setting = outcome.configuration[i]; setting != 0)
      json[means.knobs[i].key] = means.knobs[i].settings[std::size_t(setting)].value;
  return json;
}

Json times_json(const Panel& panel, std::size_t i) {
  const Outcome& outcome = panel.outcomes[i];
  if (!outcome.has_time()) return {{"time_ratio", nullptr}, {"ms", nullptr}, {"ms_p95", nullptr}};
  return {{"time_ratio", time_ratio(panel, i)},
          {"ms", outcome.ms.min_of_medians},
          {"ms_p95", outcome.ms.p95}};
}

Json mean_json(const TradeoffScenes& scenes, const ScenesPanel& panel, std::size_t i) {
  const Outcome& mean = panel.means.outcomes[i];
  Json of_scenes = Json::array();
  for (std::size_t r = 0; r < scenes.runs.size(); ++r) {
    const Panel& own = own_panel(scenes, panel, r);
    const std::size_t member = panel.members[i][r];
    Json json{{"configuration", member}};
    json.update(times_json(own, member));
    json["psnr_db"] = own.outcomes[member].error.psnr_db;
    json["coverage"] = own.outcomes[member].error.coverage_mismatch;
    of_scenes.push_back(std::move(json));
  }
  Json json{{"name", mean.name},
            {"method", name_of(mean.method)},
            {"settings", settings_json(panel.means, mean)}};
  json.update(times_json(panel.means, i));
  json["psnr_db"] = mean.error.psnr_db;
  json["worst_psnr_db"] = mean.error.worst_psnr_db;
  json["worst_scene"] = worst_run(mean);
  json["worst_coverage"] = mean.error.coverage_mismatch;
  json["on_front"] = is_on_front(panel.means, i);
  json["scenes"] = std::move(of_scenes);
  return json;
}

Json panel_json(const TradeoffScenes& scenes, const ScenesPanel& panel) {
  Json configurations = Json::array(), left_out = Json::array();
  for (std::size_t i = 0; i < panel.means.outcomes.size(); ++i)
    configurations.push_back(mean_json(scenes, panel, i));
  for (const LeftOut& each : panel.left_out)
    left_out.push_back(
        {{"name", each.name}, {"method", name_of(each.method)}, {"lacking", each.lacking}});
  return {{"configurations", configurations},
          {"front", panel.means.front},
          {"hypervolume_decade_db", panel.means.hypervolume},
          {"aa_spread", panel.means.aa_spread},
          {"r1_psnr_db", panel.means.ideal.psnr_db},
          {"left_out", left_out}};
}

// -- for people ----------------------------------------------------------------------------------

void say_panel(const TradeoffScenes& scenes, const ScenesPanel& panel, const std::string& title) {
  const Panel& means = panel.means;
  std::size_t width = 13;
  constexpr std::size_t widest = 60;  // than ours: names are those of files
  for (const Outcome& outcome : means.outcomes) width = std::max(width, outcome.name.size());
  width = std::min(width, widest);
  say(title);
  say(fmt::format("  {:<{}}  {:>8}  {:>8}  {:>8}  {:>7}  {:>8}  {:>8}  {}", "configuration", width,
                  "time", "generic", "ms", "mean dB", "worst dB", "coverage", "worst in"));
  for (std::size_t i = 0; i < means.outcomes.size(); ++i) {
    const Outcome& mean = means.outcomes[i];
    if (mean.method == Method::generic) continue;
    const Outcome* generic = generic_of(means, mean);
    const double defaults_ms = means.outcomes.front().ms.min_of_medians;
    say(fmt::format("{} {:<{}}  {:>8}  {:>8}  {:>8}  {:>7.2f}  {:>8.2f}  {:>8.1e}  {}",
                    is_on_front(means, i) ? '*' : ' ', mean.name, width,
                    mean.has_time() ? fmt::format("{:.3f}", time_ratio(means, i)) : "-",
                    generic ? fmt::format("{:.3f}", generic->ms.min_of_medians / defaults_ms) : "-",
                    mean.has_time() ? fmt::format("{:.2f}", mean.ms.min_of_medians) : "-",
                    mean.error.psnr_db, mean.error.worst_psnr_db, mean.error.coverage_mismatch,
                    worst_scene(scenes, mean)));
  }
  say("  " + summary(panel));
  say_list("Left out, as not all runs have it:", left_out_lines(scenes, panel));
}

}  // namespace

Json to_json(const TradeoffScenes& scenes) {
  Json runs = Json::array();
  for (std::size_t r = 0; r < scenes.runs.size(); ++r) runs.push_back(run_json(scenes, r));
  return {{"format", tradeoff_scenes_format},
          {"version", tradeoff_scenes_version},
          {"date", scenes.date},
          {"program", to_json(scenes.program)},
          {"samples", scenes.runs.front().report.samples},
          {"scenes", runs},
          {"drawing", panel_json(scenes, scenes.drawing)},
          {"antialiasing", panel_json(scenes, scenes.antialiasing)},
          {"notes", scenes.notes},
          {"output", scenes.output}};
}

void say_tables(const TradeoffScenes& scenes) {
  const std::size_t count = scenes.runs.size();
  say_panel(scenes, scenes.drawing,
            fmt::format("E_render of drawing knobs over {} scenes, against the oracle {} (* on the "
                        "front):",
                        count, where_it_looks(scenes.runs.front().report)));
  say_panel(scenes, scenes.antialiasing,
            fmt::format("E_render of antialiasing knobs over {} scenes, against 8 x 8 samples a "
                        "pixel (* on the front):",
                        count));
}

const std::string& worst_scene(const TradeoffScenes& scenes, const Outcome& mean) {
  return scenes.labels[worst_run(mean)];
}

std::vector<std::string> left_out_lines(const TradeoffScenes& scenes, const ScenesPanel& panel) {
  using Lacking = std::vector<std::size_t>;
  std::set<std::pair<Lacking, std::string>> specialised;
  for (const LeftOut& each : panel.left_out)
    if (each.method == Method::specialised) specialised.emplace(each.lacking, each.name);
  std::map<Lacking, std::vector<std::string>> names;
  for (const LeftOut& each : panel.left_out) {
    // What is left out in any case need not be said again of its generic twin.
    const bool is_generic = each.method == Method::generic;
    if (is_generic && specialised.count({each.lacking, each.name}) > 0) continue;
    names[each.lacking].push_back(each.name + (is_generic ? " (generic)" : ""));
  }
  std::vector<std::string> lines;
  // Lines that a terminal shows whole, see shown_line().
  constexpr std::size_t longest = 300;
  for (const auto& [lacking, ways] : names) {
    std::string who;
    for (const std::size_t r : lacking) who += (who.empty() ? "" : " and ") + scenes.labels[r];
    std::string text;
    for (const std::string& way : ways) {
      if (text.size() + way.size() > longest && !text.empty())
        lines.push_back("not in " + who + ": " + std::exchange(text, {}));
      text += (text.empty() ? "" : "; ") + way;
    }
    lines.push_back("not in " + who + ": " + text);
  }
  return lines;
}

std::string summary(const ScenesPanel& panel) {
  return fmt::format(
      "Time is relative to each scene's own defaults; it and ms are geometric means, which "
      "differ by chance by {:.1f} % (A/A). R1, the reference itself in 8 bits: {:.2f} dB. "
      "Hypervolume against the corner at 100 ms and 20 dB: {:.1f} decade dB.",
      100 * panel.means.aa_spread, panel.means.ideal.psnr_db, panel.means.hypervolume);
}

}  // namespace tureen::cli
