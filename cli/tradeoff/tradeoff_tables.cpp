#include "cli/tradeoff/tradeoff_tables.hpp"

#include <fmt/format.h>

#include "cli/measuring/bench_words.hpp"
#include "cli/report.hpp"
#include "cli/table.hpp"

namespace tureen::cli {

namespace {

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
    if (panel.outcomes[i].factor != tradeoff::Factor::generic) add_row(table, report, panel, i);
  say(title);
  for (const std::string& line : table.lines()) say(line);
  say(fmt::format("  R1, the reference in 8 bits: {:.2f} dB; A/A spread of the times: {:.1f} %",
                  panel.ideal.psnr_db, 100 * panel.aa_spread));
  std::vector<std::string> lines = panel.notes;
  for (const tradeoff::SkippedOutcome& skipped : panel.skipped)
    lines.push_back(skipped.name + ": " + skipped.reason);
  for (const tradeoff::Outcome& outcome : panel.outcomes)
    for (const std::string& warning : tradeoff::warnings_about(outcome))
      lines.push_back(outcome.name +
                      (outcome.factor == tradeoff::Factor::generic ? " (generic)" : "") + ": " +
                      warning);
  say_list("Skipped configurations and warnings:", lines);
}

void say_model(const TradeoffReport& report) {
  if (!report.model) return;
  Table table({"configuration", "PSNR dB", "SSIM"});
  for (const tradeoff::Panel* panel : {&report.study.drawing, &report.study.antialiasing})
    for (const tradeoff::Outcome& each : panel->outcomes)
      if (each.model)
        table.row({each.name, fmt::format("{:.2f}", each.model->psnr_db),
                   fmt::format("{:.4f}", each.model->ssim)});
  say_list(fmt::format("E_model, against {} photographs ({}) of {}:", report.model->photographs,
                       report.model->split, report.model->dataset),
           table.lines());
}

}  // namespace

const char* where_it_looks(const TradeoffReport& report) {
  const bool exact = report.samples != "device";
  if (report.scene.splats > 0)
    return exact ? "in exact order of the splats" : "in the order of the splats' centres";
  return exact ? "with exact triangles" : "at the device's sample points";
}

void say_tables(const TradeoffReport& report) {
  say_panel(
      report, report.study.drawing,
      fmt::format("E_render of edits, against the oracle {} (* = on the front, > = the choice):",
                  where_it_looks(report)));
  const double limit = report.study.grid.psnr_db;
  say(report.scene.splats > 0 ? fmt::format("  exact dB: PSNR against the exact order; the order "
                                            "of the centres alone limits it to {:.2f} dB",
                                            limit)
                              : fmt::format("  exact dB: PSNR against exact triangles; the "
                                            "device's subpixel grid alone limits it to {:.2f} dB",
                                            limit));
  say_panel(report, report.study.antialiasing,
            "E_render of quality settings, against 8 x 8 samples per pixel (* = on the front):");
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
