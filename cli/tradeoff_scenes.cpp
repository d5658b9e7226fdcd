#include "cli/tradeoff_scenes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "soup/error.hpp"

namespace tureen::cli {

namespace {

/// A way to draw: the method, and the values that are asked for by their knobs' keys.
struct Way {
  Method method = Method::specialised;
  std::map<std::string, std::string> settings;

  bool operator<(const Way& other) const {
    return std::tie(method, settings) < std::tie(other.method, other.settings);
  }
};

Way way_of(const Panel& panel, const Outcome& outcome) {
  Way way{outcome.method, {}};
  for (std::size_t i = 0; i < panel.knobs.size(); ++i)
    if (const int setting = outcome.configuration[i]; setting != 0)
      way.settings[panel.knobs[i].key] = panel.knobs[i].settings[std::size_t(setting)].value;
  return way;
}

/// The outcomes of one run's panel by their ways.
class Ways {
 public:
  explicit Ways(const Panel& panel) : panel_(panel) {
    for (std::size_t i = 0; i < panel.outcomes.size(); ++i)
      outcomes_.emplace(way_of(panel, panel.outcomes[i]), i);
  }

  /// Nothing where this scene lacks one of the knobs, or where that was not measured.
  std::optional<std::size_t> find(const Way& way) const {
    Way own{way.method, {}};
    for (const auto& [key, value] : way.settings) {
      const auto is_asked = [&key = key](const tradeoff::Knob& each) { return each.key == key; };
      const auto knob = std::find_if(panel_.knobs.begin(), panel_.knobs.end(), is_asked);
      if (knob == panel_.knobs.end()) return std::nullopt;
      if (value != knob->settings.front().value) own.settings.emplace(key, value);
    }
    const auto found = outcomes_.find(own);
    return found == outcomes_.end() ? std::nullopt : std::optional(found->second);
  }

 private:
  const Panel& panel_;
  std::map<Way, std::size_t> outcomes_;
};

/// Knobs of all panels in the order in which they come; the first setting is each scene's own.
std::vector<tradeoff::Knob> knobs_of(const std::vector<const Panel*>& panels) {
  std::vector<tradeoff::Knob> knobs;
  for (const Panel* panel : panels)
    for (const tradeoff::Knob& knob : panel->knobs) {
      const auto is_same = [&](const tradeoff::Knob& other) { return other.key == knob.key; };
      auto found = std::find_if(knobs.begin(), knobs.end(), is_same);
      if (found == knobs.end())
        found = knobs.insert(knobs.end(),
                             tradeoff::Knob{knob.key, knob.title, {{"", "the scene's own", {}}}});
      for (const tradeoff::Setting& setting : knob.settings) {
        const auto has_value = [&](const tradeoff::Setting& each) {
          return each.value == setting.value;
        };
        if (std::none_of(found->settings.begin(), found->settings.end(), has_value))
          found->settings.push_back({setting.value, setting.words, {}});
      }
    }
  return knobs;
}

tradeoff::Configuration configuration_of(const std::vector<tradeoff::Knob>& knobs, const Way& way) {
  tradeoff::Configuration configuration;
  for (const tradeoff::Knob& knob : knobs) {
    const auto asked = way.settings.find(knob.key);
    int setting = 0;
    if (asked != way.settings.end())
      while (knob.settings[std::size_t(setting)].value != asked->second) ++setting;
    configuration.push_back(setting);
  }
  return configuration;
}

double geometric_mean_of(const std::vector<const Outcome*>& members,
                         const std::function<double(const FrameStatistics&)>& get) {
  std::vector<double> values;
  for (const Outcome* each : members) values.push_back(get(each->ms));
  return geometric_mean(values);
}

/// Of outcomes of one method: one a run.
Outcome mean_of(const std::vector<const Outcome*>& members) {
  Outcome result;
  result.method = members.front()->method;
  if (result.has_time()) {
    result.ms.min_of_medians =
        geometric_mean_of(members, [](const FrameStatistics& ms) { return ms.min_of_medians; });
    result.ms.median =
        geometric_mean_of(members, [](const FrameStatistics& ms) { return ms.median; });
    result.ms.p95 = geometric_mean_of(members, [](const FrameStatistics& ms) { return ms.p95; });
  }
  RenderError& error = result.error;
  for (const Outcome* each : members) {
    error.view_psnr_db.push_back(each->error.psnr_db);
    error.coverage_mismatch = std::max(error.coverage_mismatch, each->error.coverage_mismatch);
  }
  error.psnr_db = mean(error.view_psnr_db);
  error.worst_psnr_db = *std::min_element(error.view_psnr_db.begin(), error.view_psnr_db.end());
  return result;
}

ScenesPanel join_panels(const std::vector<const Panel*>& panels) {
  ScenesPanel joined;
  joined.means.knobs = knobs_of(panels);
  std::vector<Ways> runs;
  for (const Panel* panel : panels) runs.emplace_back(*panel);
  std::set<Way> known;
  for (const Panel* panel : panels)
    for (const Outcome& outcome : panel->outcomes) {
      const Way way = way_of(*panel, outcome);
      if (!known.insert(way).second) continue;
      LeftOut left_out{outcome.name, outcome.method, {}};
      std::vector<std::size_t> indices;
      std::vector<const Outcome*> members;
      for (std::size_t r = 0; r < runs.size(); ++r) {
        if (const std::optional<std::size_t> index = runs[r].find(way)) {
          indices.push_back(*index);
          members.push_back(&panels[r]->outcomes[*index]);
        } else {
          left_out.lacking.push_back(r);
        }
      }
      if (!left_out.lacking.empty()) {
        joined.left_out.push_back(std::move(left_out));
        continue;
      }
      joined.means.outcomes.push_back(mean_of(members));
      joined.means.outcomes.back().configuration = configuration_of(joined.means.knobs, way);
      joined.means.outcomes.back().name = outcome.name;
      joined.members.push_back(std::move(indices));
    }

  std::vector<double> factors, ideals;
  for (const Panel* panel : panels) {
    factors.push_back(1 + 2 * panel->aa_spread);
    ideals.push_back(panel->ideal.psnr_db);
  }
  joined.means.ideal.psnr_db = mean(ideals);
  // Were every time off by as much as chance allows, and all in one direction, the geometric mean
  // would be off by the geometric mean of that.
  joined.means.aa_spread = (geometric_mean(factors) - 1) / 2;
  find_front(joined.means);
  return joined;
}

std::string path_of(const TradeoffRun& run) {
  return std::filesystem::path(run.report.scene.path).lexically_normal().string();
}

bool is_same_scene(const TradeoffRun& a, const TradeoffRun& b) {
  const BenchScene &first = a.report.scene, &second = b.report.scene;
  return first.name == second.name && first.triangles == second.triangles &&
         first.appearance == second.appearance && path_of(a) == path_of(b);
}

void check(const std::vector<TradeoffRun>& runs) {
  for (std::size_t i = 1; i < runs.size(); ++i) {
    const TradeoffRun& run = runs[i];
    for (std::size_t k = 0; k < i; ++k)
      if (is_same_scene(run, runs[k]))
        throw InputError({run.file, {}, {}}, "scene: \"" + run.report.scene.path +
                                                 "\" is that of " + runs[k].file +
                                                 ", too; a scene counts once");
    if (run.report.samples != runs[0].report.samples)
      throw InputError({run.file, {}, {}},
                       "protocol.samples: \"" + run.report.samples + "\", and \"" +
                           runs[0].report.samples + "\" in " + runs[0].file +
                           ": errors against different references have no mean");
  }
}

std::vector<std::string> labels_of(const std::vector<TradeoffRun>& runs) {
  std::vector<std::string> names, files;
  for (const TradeoffRun& run : runs) {
    names.push_back(run.report.scene.name);
    files.push_back(run.file);
  }
  const std::set<std::string> distinct(names.begin(), names.end());
  return distinct.size() == names.size() ? names : files;
}

/// What should be the same in all runs; where it is not, a note says so.
std::vector<std::string> differences(const std::vector<TradeoffRun>& runs,
                                     const std::vector<std::string>& labels) {
  using Get = std::function<std::string(const TradeoffReport&)>;
  const std::vector<std::pair<std::string, Get>> parts{
      {"device", [](const TradeoffReport& r) { return r.device.renderer; }},
      {"machine", [](const TradeoffReport& r) { return r.machine.cpu; }},
      {"clock", [](const TradeoffReport& r) { return r.clock; }},
      {"size", [](const TradeoffReport& r) { return fmt::format("{} x {}", r.width, r.height); }},
      {"number of views", [](const TradeoffReport& r) { return fmt::format("{}", r.views); }},
      {"number of rounds", [](const TradeoffReport& r) { return fmt::format("{}", r.rounds); }},
      {"commit", [](const TradeoffReport& r) { return r.program.commit; }}};
  std::vector<std::string> notes;
  bool comparable = true;
  for (const auto& [name, get] : parts) {
    std::string values;
    std::set<std::string> distinct;
    for (std::size_t r = 0; r < runs.size(); ++r) {
      const std::string value = get(runs[r].report);
      distinct.insert(value);
      values += (r ? "; " : "") + labels[r] + ": " + value;
    }
    if (distinct.size() < 2) continue;
    notes.push_back("the runs differ in their " + name + ": " + values);
    comparable =
        comparable && name != "device" && name != "machine" && name != "clock" && name != "size";
  }
  if (!comparable)
    notes.emplace_back(
        "time is relative to each run's own defaults; milliseconds and hypervolume are of use "
        "only where device, machine, clock and size are the same");
  return notes;
}

/// What a run itself says against its times, above all those of its defaults, by which all others
/// of it are divided.
void add_warnings(const TradeoffRun& run, const std::string& label,
                  std::vector<std::string>& notes) {
  for (const Panel* panel : {&run.report.study.drawing, &run.report.study.antialiasing}) {
    if (const auto warning = spread_warning(panel->aa_spread))
      notes.push_back(label + ": " + *warning);
    for (const std::string& warning : panel->outcomes.front().warnings)
      notes.push_back(label + ", its defaults: " + warning);
  }
}

}  // namespace

TradeoffScenes join(std::vector<TradeoffRun> runs) {
  assert(runs.size() > 1);
  check(runs);
  TradeoffScenes scenes;
  scenes.labels = labels_of(runs);
  scenes.notes = differences(runs, scenes.labels);
  for (std::size_t r = 0; r < runs.size(); ++r)
    add_warnings(runs[r], scenes.labels[r], scenes.notes);
  std::vector<const Panel*> drawing, antialiasing;
  for (const TradeoffRun& run : runs) {
    drawing.push_back(&run.report.study.drawing);
    antialiasing.push_back(&run.report.study.antialiasing);
  }
  scenes.drawing = join_panels(drawing);
  scenes.antialiasing = join_panels(antialiasing);
  const Panel& means = scenes.antialiasing.means;
  for (const Outcome& outcome : means.outcomes)
    if (!is_judged(means, outcome)) scenes.notes.push_back(outcome.name + ": " + not_judged);
  scenes.runs = std::move(runs);
  return scenes;
}

const Panel& own_panel(const TradeoffScenes& scenes, const ScenesPanel& panel, std::size_t run) {
  const Study& study = scenes.runs[run].report.study;
  return &panel == &scenes.drawing ? study.drawing : study.antialiasing;
}

double time_ratio(const Panel& panel, std::size_t outcome) {
  return panel.outcomes[outcome].ms.min_of_medians / panel.outcomes.front().ms.min_of_medians;
}

const Outcome* published_of(const ScenesPanel& panel) {
  for (const Outcome& outcome : panel.means.outcomes)
    if (outcome.method == Method::published) return &outcome;
  return nullptr;
}

}  // namespace tureen::cli
