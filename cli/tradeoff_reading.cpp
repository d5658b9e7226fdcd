#include "cli/tradeoff_reading.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <tuple>

#include "cli/json_reading.hpp"
#include "cli/provenance.hpp"
#include "formats/json_file.hpp"

namespace tureen::cli {

namespace {

/// --combinations asks for 10,000 at most; the star, with its generic twins, has some hundreds. Of
/// ours some 8,000 fill the bytes that a file of JSON may have.
constexpr std::size_t most_configurations = 20'000;
/// Several times what there are.
constexpr std::size_t most_knobs = 64, most_settings = 64;

/// Of a frame: from a nanosecond, less than any clock tells, to eleven days, so that neither ratios
/// nor their products leave what a double holds.
double frame_ms(const JsonView& view) { return number_in(view, 1e-6, 1e9); }
double fraction(const JsonView& view) { return number_in(view, 0, 1); }
/// Of colours in [0, 1] as far apart as can be, to the most that psnr_from_mse() says.
double decibels(const JsonView& view) { return number_in(view, 0, 100); }

void require_at_most(const JsonView& view, std::size_t most) {
  if (view.size() > most)
    view.fail(fmt::format("has {} elements, at most {} are expected", view.size(), most));
}

/// What names a row of tables: every row is as wide as the widest. Several times what a combination
/// of all knobs takes.
std::string name_of(const JsonView& view) { return text_within(view, 1000); }

std::size_t index_of(const JsonView& view, std::size_t size) {
  if (size == 0) view.fail("there is nothing to point at");
  return std::size_t(view.natural(size - 1));
}

/// FLIP, which is there everywhere or nowhere.
double flip_of(const JsonView& view, bool with_flip) {
  if (with_flip) return fraction(view);
  if (!view.value().is_null()) view.fail("expected null: the run left FLIP out");
  return 0;
}

RenderError render_error_of(const JsonView& view, const TradeoffReport& report) {
  RenderError error{.psnr_db = decibels(view["psnr_db"]),
                    .mean_psnr_db = decibels(view["mean_psnr_db"]),
                    .worst_psnr_db = decibels(view["worst_psnr_db"]),
                    .mse = fraction(view["mse"]),
                    .mae = fraction(view["mae"]),
                    .max_abs = fraction(view["max"]),
                    .p999_abs = fraction(view["p999"]),
                    .ssim = number_in(view["ssim"], -1, 1),
                    .flip = flip_of(view["flip"], report.with_flip),
                    .coverage_mismatch = fraction(view["coverage"]),
                    .view_psnr_db = list(view["view_psnr_db"], decibels)};
  if (error.view_psnr_db.size() != std::size_t(report.views))
    view["view_psnr_db"].fail(fmt::format("has {} elements, expected one for each of {} views",
                                          error.view_psnr_db.size(), report.views));
  return error;
}

ExactError exact_error_of(const JsonView& view) {
  return {.psnr_db = decibels(view["psnr_db"]), .coverage_mismatch = fraction(view["coverage"])};
}

tradeoff::Knob knob_of(const JsonView& view) {
  const JsonView settings = view["settings"];
  require_at_most(settings, most_settings);
  if (settings.size() == 0) settings.fail("is empty");
  tradeoff::Knob knob{name_of(view["key"]), name_of(view["title"]), {}};
  for (const std::string& value : texts(settings)) {
    for (const tradeoff::Setting& other : knob.settings)
      if (other.value == value) settings.fail("holds \"" + value + "\" twice");
    knob.settings.push_back({value, value, {}});
  }
  return knob;
}

void read_knobs(const JsonView& view, Panel& panel) {
  require_at_most(view, most_knobs);
  for (std::size_t i = 0; i < view.size(); ++i) {
    const JsonView each = view.at(i);
    tradeoff::Knob knob = knob_of(each);
    for (const tradeoff::Knob& other : panel.knobs)
      if (other.key == knob.key) each["key"].fail("\"" + knob.key + "\" is there twice");
    panel.knobs.push_back(std::move(knob));
    panel.ranges.push_back({.knob = i,
                            .time_ratio = number_in(each["time_ratio"], 1, 1e15),
                            .psnr_db = decibels(each["psnr_range_db"])});
    boolean(each["matters"]);  // follows from the two
  }
}

tradeoff::Configuration configuration_of(const JsonView& view, const Panel& panel) {
  tradeoff::Configuration configuration;
  for (const tradeoff::Knob& knob : panel.knobs) {
    const JsonView value = view[knob.key.c_str()];
    const auto is_meant = [&](const tradeoff::Setting& each) { return each.value == value.text(); };
    const auto found = std::find_if(knob.settings.begin(), knob.settings.end(), is_meant);
    if (found == knob.settings.end()) value.fail("is no setting of the knob " + knob.key);
    configuration.push_back(int(found - knob.settings.begin()));
  }
  if (view.value().size() != panel.knobs.size()) view.fail("holds knobs that the panel lacks");
  return configuration;
}

void read_times(const JsonView& view, Outcome& outcome) {
  if (!outcome.has_time()) {
    for (const char* key : {"ms", "ms_median", "ms_p95", "ms_spread", "mib"})
      if (!view[key].value().is_null()) view[key].fail("expected null: the oracle takes no time");
    return;
  }
  outcome.ms.min_of_medians = frame_ms(view["ms"]);
  outcome.ms.median = frame_ms(view["ms_median"]);
  outcome.ms.p95 = frame_ms(view["ms_p95"]);
  outcome.ms.spread = number_in(view["ms_spread"], 0, 1e9) / outcome.ms.min_of_medians;
  outcome.device_mib = number_in(view["mib"], 0, 1e12);
}

Outcome outcome_of(const JsonView& view, const TradeoffReport& report, const Panel& panel) {
  // What they repeat is read where it stands once.
  for (const char* key : {"scene", "commit", "machine", "driver"}) view[key].text();
  Outcome outcome;
  outcome.name = name_of(view["name"]);
  outcome.method = Method(view["method"].one_of(method_names));
  outcome.configuration = configuration_of(view["knobs"], panel);
  read_times(view, outcome);
  outcome.error = render_error_of(view["e_render"], report);
  outcome.exact = unless_null(view["e_render_exact"], exact_error_of);
  outcome.warnings = texts(view["warnings"]);
  return outcome;
}

void read_outcomes(const JsonView& view, const TradeoffReport& report, Panel& panel) {
  require_at_most(view, most_configurations);
  if (view.size() == 0) view.fail("is empty");
  std::set<std::tuple<Method, tradeoff::Configuration>> known;
  for (std::size_t i = 0; i < view.size(); ++i) {
    Outcome outcome = outcome_of(view.at(i), report, panel);
    if (!known.emplace(outcome.method, outcome.configuration).second)
      view.at(i).fail("the same method and knobs stand before it");
    panel.outcomes.push_back(std::move(outcome));
  }
  const Outcome& first = panel.outcomes.front();
  if (first.departures() > 0 || first.method != Method::specialised)
    view.at(0).fail("is not the defaults, with which a panel begins");
}

void read_front(const JsonView& view, const JsonView& configurations, Panel& panel) {
  std::vector<bool> on_front(panel.outcomes.size());
  for (std::size_t i = 0; i < view.size(); ++i) {
    const std::size_t index = index_of(view.at(i), panel.outcomes.size());
    if (on_front[index]) view.at(i).fail("stands there twice");
    if (!panel.outcomes[index].has_time()) view.at(i).fail("has no time");
    on_front[index] = true;
    panel.front.push_back(index);
  }
  for (std::size_t i = 0; i < on_front.size(); ++i)
    if (const JsonView each = configurations.at(i)["on_front"]; boolean(each) != on_front[i])
      each.fail("the panel's front says otherwise");
}

Panel panel_of(const JsonView& view, const TradeoffReport& report) {
  Panel panel;
  read_knobs(view["knobs"], panel);
  read_outcomes(view["configurations"], report, panel);
  read_front(view["front"], view["configurations"], panel);
  panel.hypervolume = number_in(view["hypervolume_decade_db"], 0, 1e6);
  panel.aa_spread = number_in(view["aa_spread"], 0, 1e15);
  panel.ideal = render_error_of(view["r1"], report);
  panel.skipped = list(view["skipped"], [](const JsonView& each) {
    return Skipped{each["name"].text(), each["reason"].text()};
  });
  panel.notes = texts(view["notes"]);
  return panel;
}

void read_protocol(const JsonView& view, TradeoffReport& report) {
  constexpr std::array<const char*, 2> samples{"device", "exact"};
  report.camera_set = name_of(view["camera_set"]);
  report.width = count_of(view["width"]);
  report.height = count_of(view["height"]);
  report.views = count_of(view["views"]);
  report.rounds = count_of(view["rounds"]);
  report.clock = name_of(view["clock"]);
  report.samples = samples[view["samples"].one_of(samples)];
}

std::vector<std::optional<ModelError>> models_of(const JsonView& configurations,
                                                 const TradeoffReport& report) {
  std::vector<std::optional<ModelError>> models;
  for (std::size_t i = 0; i < configurations.size(); ++i) {
    const JsonView view = configurations.at(i)["e_model"];
    models.push_back(unless_null(view, [&](const JsonView& each) {
      return ModelError{.psnr_db = decibels(each["psnr_db"]),
                        .ssim = number_in(each["ssim"], -1, 1),
                        .flip = flip_of(each["flip"], report.with_flip)};
    }));
    if (models.back() && !report.model) view.fail("the run has no photographs");
  }
  if (!report.model) return {};
  // The others are held against the defaults.
  if (!models.front()) configurations.at(0)["e_model"].fail("expected an object: a run has it");
  return models;
}

ModelProtocol model_protocol_of(const JsonView& view) {
  return {.dataset = view["dataset"].text(),
          .split = view["split"].text(),
          .photographs = integer(view["photographs"]),
          .ssim_border = view["ssim_border"].text()};
}

void read_choice(const JsonView& view, TradeoffReport& report) {
  if (view.value().is_null()) return;
  const std::vector<Outcome>& outcomes = report.study.drawing.outcomes;
  report.study.choice = index_of(view["configuration"], outcomes.size());
  if (!outcomes[*report.study.choice].has_time()) view["configuration"].fail("has no time");
  view["name"].text();
  decibels(view["psnr_db"]);
  report.promised_psnr_db = unless_null(view["promised_psnr_db"], decibels);
  report.preset_written =
      unless_null(view["written"], [](const JsonView& each) { return each.text(); });
}

void read_r0(const JsonView& view, Study& study) {
  if (view.value().is_null()) return;
  study.published = index_of(view, study.drawing.outcomes.size());
  if (study.drawing.outcomes[*study.published].method != Method::published)
    view.fail("is not drawn by the published pipeline");
}

}  // namespace

TradeoffReport read_tradeoff(Input& input) {
  const nlohmann::json document = read_json(input);
  const JsonView root(document, input.name());
  require_format(root, tradeoff_format, tradeoff_version, "no result of tureen tradeoff");
  TradeoffReport report;
  report.date = date_of(root["date"]);
  report.program = program_of(root["program"]);
  report.scene = scene_of(root["scene"]);
  report.machine = machine_of(root["machine"]);
  report.device = device_of(root["device"]);
  read_protocol(root["protocol"], report);
  const JsonView limits = root["limits"], drawing = root["drawing"],
                 antialiasing = root["antialiasing"];
  report.limits = {.least_psnr_db = decibels(limits["least_psnr_db"]),
                   .most_coverage_mismatch = fraction(limits["most_coverage_mismatch"])};
  report.with_flip = !root["subpixel_grid"]["flip"].value().is_null();
  report.study.grid = render_error_of(root["subpixel_grid"], report);
  report.study.drawing = panel_of(drawing, report);
  report.study.antialiasing = panel_of(antialiasing, report);
  read_r0(root["r0"], report.study);
  report.model = unless_null(root["e_model"], model_protocol_of);
  report.drawing_model = models_of(drawing["configurations"], report);
  report.antialiasing_model = models_of(antialiasing["configurations"], report);
  read_choice(root["choice"], report);
  report.notes = texts(root["notes"]);
  report.output = texts(root["output"]);
  return report;
}

}  // namespace tureen::cli
