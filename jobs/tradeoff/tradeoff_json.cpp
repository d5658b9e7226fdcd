#include "jobs/tradeoff/tradeoff_json.hpp"

namespace tureen::results {

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

Json configuration_json(const TradeoffReport& report, const tradeoff::Panel& panel, std::size_t i) {
  const tradeoff::Outcome& outcome = panel.outcomes[i];
  return {{"name", outcome.name},
          {"scene", report.scene.name},
          {"method", name_of(outcome.factor)},
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
          {"e_model", to_json(outcome.model, report.with_flip)},
          {"on_front", tradeoff::is_on_front(panel, i)},
          {"stable", outcome.stable},
          {"judged", tradeoff::is_judged(outcome)},
          {"non_finite_pixels", outcome.error.non_finite},
          {"warnings", tradeoff::warnings_about(outcome)}};
}

Json panel_json(const TradeoffReport& report, const tradeoff::Panel& panel) {
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
    configurations.push_back(configuration_json(report, panel, i));
  for (const tradeoff::SkippedOutcome& each : panel.skipped)
    skipped.push_back({{"name", each.name}, {"reason", each.reason}});
  return {{"knobs", settings},
          {"configurations", configurations},
          {"front", panel.front},
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

}  // namespace

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
          {"drawing", panel_json(report, study.drawing)},
          {"antialiasing", panel_json(report, study.antialiasing)},
          {"r0", study.baseline ? Json(*study.baseline) : Json(nullptr)},
          {"subpixel_grid", to_json(study.grid, report.with_flip)},
          {"e_model", model_protocol_json(report)},
          {"choice", choice_json(report)},
          {"notes", report.notes},
          {"output", report.output}};
}

}  // namespace tureen::results
