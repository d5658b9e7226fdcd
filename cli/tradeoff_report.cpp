#include "cli/tradeoff_report.hpp"

#include <fmt/format.h>

#include "cli/bench_words.hpp"
#include "cli/provenance.hpp"
#include "cli/table.hpp"

namespace tureen::cli {

namespace {

Json to_json(const RenderError& error, bool with_flip) {
  Json json{{"psnr_db", error.psnr_db},
            {"mean_psnr_db", error.mean_psnr_db},
            {"worst_psnr_db", error.worst_psnr_db},
            {"mse", error.mse},
            {"mae", error.mae},
            {"max", error.max_abs},
            {"p999", error.p999_abs},
            {"ssim", error.ssim},
            {"flip", nullptr},
            {"coverage", error.coverage_mismatch},
            {"view_psnr_db", error.view_psnr_db}};
  if (with_flip) json["flip"] = error.flip;
  return json;
}

Json to_json(const std::optional<tradeoff::ModelError>& error, bool with_flip) {
  if (!error) return nullptr;
  return {{"psnr_db", error->psnr_db},
          {"ssim", error->ssim},
          {"flip", with_flip ? Json(error->flip) : Json(nullptr)}};
}

Json to_json(const std::optional<tradeoff::ExactError>& error) {
  if (!error) return nullptr;
  return {{"psnr_db", error->psnr_db}, {"coverage", error->coverage_mismatch}};
}

Json settings_json(const tradeoff::Panel& panel, const tradeoff::Outcome& outcome) {
  Json json = Json::object();
  for (std::size_t i = 0; i < panel.settings.size(); ++i)
    json[panel.settings[i].key] =
        panel.settings[i].values[std::size_t(outcome.configuration[i])].value;
  return json;
}

std::optional<tradeoff::ModelError> model_of(
    const std::vector<std::optional<tradeoff::ModelError>>& list, std::size_t i) {
  return i < list.size() ? list[i] : std::nullopt;
}

Json configuration_json(const TradeoffReport& report, const tradeoff::Panel& panel, std::size_t i,
                        const std::optional<tradeoff::ModelError>& model) {
  const tradeoff::Outcome& outcome = panel.outcomes[i];
  return {{"name", outcome.name},
          {"scene", report.scene.name},
          {"method", name_of(outcome.method)},
          {"knobs", settings_json(panel, outcome)},
          {"commit", report.program.commit},
          {"machine", report.machine.cpu},
          {"driver", report.device.renderer + "; " + report.device.version},
          {"ms", outcome.ms.min_of_medians},
          {"ms_median", outcome.ms.median},
          {"ms_p95", outcome.ms.p95},
          {"ms_spread", outcome.ms.spread * outcome.ms.min_of_medians},
          {"mib", outcome.device_mib},
          {"e_render", to_json(outcome.error, report.with_flip)},
          {"e_render_exact", to_json(outcome.exact)},
          {"e_model", to_json(model, report.with_flip)},
          {"on_front", tradeoff::is_on_front(panel, i)},
          {"stable", outcome.stable},
          {"judged", tradeoff::is_judged(outcome)},
          {"non_finite_pixels", outcome.error.non_finite},
          {"warnings", tradeoff::warnings_about(outcome)}};
}

Json panel_json(const TradeoffReport& report, const tradeoff::Panel& panel,
                const std::vector<std::optional<tradeoff::ModelError>>& model) {
  Json settings = Json::array(), configurations = Json::array(), skipped = Json::array();
  for (std::size_t i = 0; i < panel.settings.size(); ++i) {
    Json values = Json::array();
    for (const tradeoff::SettingValue& value : panel.settings[i].values)
      values.push_back(value.value);
    settings.push_back({{"key", panel.settings[i].key},
                        {"title", panel.settings[i].title},
                        {"settings", values},
                        {"time_ratio", panel.ranges[i].time_ratio},
                        {"psnr_range_db", panel.ranges[i].psnr_db},
                        {"matters", panel.ranges[i].matters()}});
  }
  for (std::size_t i = 0; i < panel.outcomes.size(); ++i)
    configurations.push_back(configuration_json(report, panel, i, model_of(model, i)));
  for (const tradeoff::SkippedOutcome& each : panel.skipped)
    skipped.push_back({{"name", each.name}, {"reason", each.reason}});
  return {{"knobs", settings},
          {"configurations", configurations},
          {"front", panel.front},
          {"hypervolume_decade_db", panel.hypervolume},
          {"aa_spread", panel.aa_spread},
          {"r1", to_json(panel.ideal, report.with_flip)},
          {"skipped", skipped},
          {"notes", panel.notes}};
}

Json choice_json(const TradeoffReport& report) {
  const tradeoff::Study& study = report.study;
  if (!study.choice) return nullptr;
  const tradeoff::Outcome& outcome = study.drawing.outcomes[*study.choice];
  return {{"configuration", *study.choice},
          {"name", outcome.name},
          {"psnr_db", outcome.error.psnr_db},
          {"written", report.scene_written ? Json(*report.scene_written) : Json(nullptr)}};
}

Json model_protocol_json(const TradeoffReport& report) {
  if (!report.model) return nullptr;
  return {{"dataset", report.model->dataset},
          {"split", report.model->split},
          {"photographs", report.model->photographs},
          {"ssim_border", report.model->ssim_border}};
}

// -- for people ----------------------------------------------------------------------------------

void add_row(Table& table, const TradeoffReport& report, const tradeoff::Panel& panel,
             std::size_t i) {
  const tradeoff::Outcome& outcome = panel.outcomes[i];
  const RenderError& error = outcome.error;
  const bool chosen = &panel == &report.study.drawing && report.study.choice == i;
  const tradeoff::Outcome* generic = tradeoff::generic_of(panel, outcome);
  table.row({chosen                            ? ">"
             : tradeoff::is_on_front(panel, i) ? "*"
                                               : "",
             outcome.name, ms_text(outcome.ms.min_of_medians),
             generic ? ms_text(generic->ms.min_of_medians) : not_known,
             fmt::format("{:.2f}", error.psnr_db),
             outcome.exact ? fmt::format("{:.2f}", outcome.exact->psnr_db) : not_known,
             fmt::format("{:.3f}", error.max_abs), fmt::format("{:.4f}", error.p999_abs),
             fmt::format("{:.1e}", error.coverage_mismatch),
             fmt::format("{:.1f}", outcome.device_mib)});
}

void say_panel(const TradeoffReport& report, const tradeoff::Panel& panel,
               const std::string& title) {
  Table table({"", "<configuration", "ms", "generic ms", "PSNR dB", "exact dB", "max", "99.9 %",
               "coverage", "MiB"});
  for (std::size_t i = 0; i < panel.outcomes.size(); ++i)
    if (panel.outcomes[i].method != tradeoff::Method::generic) add_row(table, report, panel, i);
  say(title);
  for (const std::string& line : table.lines()) say(line);
  say(
      fmt::format("  R1, the reference in 8 bits: {:.2f} dB; A/A spread of the times: {:.1f} %; "
                  "hypervolume: {:.1f} decade dB",
                  panel.ideal.psnr_db, 100 * panel.aa_spread, panel.hypervolume));
  std::vector<std::string> lines = panel.notes;
  for (const tradeoff::SkippedOutcome& skipped : panel.skipped)
    lines.push_back(skipped.name + ": " + skipped.reason);
  for (const tradeoff::Outcome& outcome : panel.outcomes)
    for (const std::string& warning : tradeoff::warnings_about(outcome))
      lines.push_back(outcome.name +
                      (outcome.method == tradeoff::Method::generic ? " (generic)" : "") + ": " +
                      warning);
  say_list("Skipped configurations and warnings:", lines);
}

void say_model(const TradeoffReport& report) {
  if (!report.model) return;
  Table table({"configuration", "PSNR dB", "SSIM"});
  const auto add = [&](const tradeoff::Panel& panel,
                       const std::vector<std::optional<tradeoff::ModelError>>& list) {
    for (std::size_t i = 0; i < list.size(); ++i)
      if (list[i])
        table.row({panel.outcomes[i].name, fmt::format("{:.2f}", list[i]->psnr_db),
                   fmt::format("{:.4f}", list[i]->ssim)});
  };
  add(report.study.drawing, report.drawing_model);
  add(report.study.antialiasing, report.antialiasing_model);
  say_list(fmt::format("E_model, against {} photographs ({}) of {}:", report.model->photographs,
                       report.model->split, report.model->dataset),
           table.lines());
}

}  // namespace

const char* where_it_looks(const TradeoffReport& report) {
  return report.samples == "device" ? "at the device's own sample points" : "with exact triangles";
}

Json to_json(const TradeoffReport& report) {
  const tradeoff::Study& study = report.study;
  return {{"format", tradeoff_format},
          {"version", tradeoff_version},
          {"date", report.date},
          {"program", to_json(report.program)},
          {"scene", to_json(report.scene)},
          {"machine", to_json(report.machine)},
          {"device", to_json(report.device)},
          {"protocol",
           {{"camera_set", report.camera_set},
            {"width", report.width},
            {"height", report.height},
            {"views", report.views},
            {"rounds", report.rounds},
            {"clock", report.clock},
            {"processor_time", report.processor_time},
            {"samples", report.samples}}},
          {"limits",
           {{"least_psnr_db", report.limits.min_psnr_db},
            {"most_coverage_mismatch", report.limits.max_coverage_mismatch}}},
          {"drawing", panel_json(report, study.drawing, report.drawing_model)},
          {"antialiasing", panel_json(report, study.antialiasing, report.antialiasing_model)},
          {"r0", study.baseline ? Json(*study.baseline) : Json(nullptr)},
          {"subpixel_grid", to_json(study.grid, report.with_flip)},
          {"e_model", model_protocol_json(report)},
          {"choice", choice_json(report)},
          {"notes", report.notes},
          {"output", report.output}};
}

void say_tables(const TradeoffReport& report) {
  say_panel(report, report.study.drawing,
            fmt::format("E_render of edits, against the oracle {} (* on the front, > the choice):",
                        where_it_looks(report)));
  say(
      fmt::format("  exact dB: PSNR against exact triangles; the device's subpixel grid alone "
                  "limits it to {:.2f} dB",
                  report.study.grid.psnr_db));
  say_panel(report, report.study.antialiasing,
            "E_render of quality settings, against 8 x 8 samples a pixel (* on the front):");
  say_model(report);
  say("Times: " + report.clock + ".");
  say(choice_sentence(report));
}

std::string choice_sentence(const TradeoffReport& report) {
  const tradeoff::Study& study = report.study;
  const std::string limits =
      fmt::format("at least {:g} dB and a mismatch of at most {:g}", report.limits.min_psnr_db,
                  report.limits.max_coverage_mismatch);
  if (!study.choice) return "No configuration is within the limits: " + limits + ".";
  const tradeoff::Outcome& chosen = study.drawing.outcomes[*study.choice];
  const tradeoff::Outcome& defaults = study.drawing.outcomes.front();
  return fmt::format(
      "The fastest configuration with {}: {}, {} ms at {:.2f} dB; the defaults take {} ms.", limits,
      chosen.name, ms_text(chosen.ms.min_of_medians), chosen.error.psnr_db,
      ms_text(defaults.ms.min_of_medians));
}

}  // namespace tureen::cli
