#include "cli/tradeoff_page.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cli/bench_words.hpp"
#include "cli/gnuplot.hpp"
#include "cli/html_page.hpp"

namespace tureen::cli {

namespace {

using Column = HtmlPage::Column;

void add_facts(HtmlPage& page, const TradeoffReport& report) {
  const BenchDevice& device = report.device;
  std::vector<std::pair<std::string, std::string>> facts{
      {"scene", fmt::format("{}, {} triangles, {}", report.scene.path,
                            counted(report.scene.triangles), report.scene.appearance)},
      {"device", fmt::format("{} ({}), {}{}", device.renderer, device.context, device.version,
                             device.software ? "; software: never compare with a GPU" : "")},
      {"machine", fmt::format("{}, {} cores", report.machine.cpu, report.machine.cores)},
      {"views", fmt::format("{} of {} x {} ({}), {}", report.views, report.width, report.height,
                            report.camera_set, count_text(report.rounds, "round"))},
      {"times", report.clock},
      {"program", fmt::format("tureen {} ({}), {}", report.program.version, report.program.commit,
                              report.date)}};
  if (report.model)
    facts.emplace_back("photographs", fmt::format("{} ({}) of {}", report.model->photographs,
                                                  report.model->split, report.model->dataset));
  page.facts(facts);
  std::string line = "tureen";
  for (const std::string& argument : report.program.arguments) line += " " + argument;
  page.command(line);
}

std::string mark(const TradeoffReport& report, const Panel& panel, std::size_t i) {
  std::vector<std::string> marks;
  if (&panel == &report.study.drawing && report.study.choice == i) marks.push_back("choice");
  if (is_on_front(panel, i)) marks.push_back("front");
  for (const std::string& warning : panel.outcomes[i].warnings) marks.push_back(warning);
  std::string text;
  for (const std::string& each : marks) text += (text.empty() ? "" : ", ") + each;
  return text;
}

void add_panel(HtmlPage& page, const TradeoffReport& report, const Panel& panel) {
  std::vector<HtmlPage::Heading> headings{{"configuration", Column::text},
                                          {"drawn by", Column::text},
                                          {"ms"},
                                          {"p95 ms"},
                                          {"MiB"},
                                          {"PSNR dB"},
                                          {"exact dB"},
                                          {"MAE"},
                                          {"max"},
                                          {"99.9 %"},
                                          {"SSIM"},
                                          {"FLIP"},
                                          {"coverage"},
                                          {"", Column::text}};
  std::vector<std::vector<std::string>> rows;
  for (std::size_t i = 0; i < panel.outcomes.size(); ++i) {
    const Outcome& outcome = panel.outcomes[i];
    const RenderError& error = outcome.error;
    const auto timed = [&](double value) {
      return outcome.has_time() ? fmt::format("{:.2f}", value) : std::string("–");
    };
    rows.push_back({outcome.name, name_of(outcome.method), timed(outcome.ms.min_of_medians),
                    timed(outcome.ms.p95), timed(outcome.device_mib),
                    fmt::format("{:.2f}", error.psnr_db),
                    outcome.exact ? fmt::format("{:.2f}", outcome.exact->psnr_db) : "–",
                    fmt::format("{:.5f}", error.mae), fmt::format("{:.3f}", error.max_abs),
                    fmt::format("{:.4f}", error.p999_abs), fmt::format("{:.5f}", error.ssim),
                    report.with_flip ? fmt::format("{:.4f}", error.flip) : "–",
                    fmt::format("{:.1e}", error.coverage_mismatch), mark(report, panel, i)});
  }
  page.table(headings, rows);
  page.paragraph(
      fmt::format("Times differ by chance by {:.1f} % (A/A). Hypervolume against the corner at "
                  "100 ms and 20 dB: {:.1f} decade dB.",
                  100 * panel.aa_spread, panel.hypervolume));
  std::vector<std::string> lines = panel.notes;
  for (const Skipped& skipped : panel.skipped)
    lines.push_back("not measured: " + skipped.name + ": " + skipped.reason);
  if (!lines.empty()) page.list(lines);
}

void add_ranges(HtmlPage& page, const Panel& panel) {
  std::vector<std::vector<std::string>> rows;
  for (const tradeoff::KnobRange& range : panel.ranges)
    rows.push_back({panel.knobs[range.knob].title, fmt::format("{:.2f}", range.time_ratio),
                    fmt::format("{:.2f}", range.psnr_db), range.matters() ? "yes" : ""});
  page.table({{"knob", Column::text},
              {"slowest / fastest"},
              {"best - worst, dB"},
              {"matters", Column::text}},
             rows);
}

void add_model(HtmlPage& page, const TradeoffReport& report) {
  if (!report.model) return;
  page.section("E_model: against photographs");
  page.paragraph(
      "How near the trained model comes to photographs, and how little of that a knob takes; and "
      "how near the published pipeline comes. This is another error than the one above: never "
      "compare the two.");
  std::vector<std::vector<std::string>> rows;
  const auto add = [&](const Panel& panel, const std::vector<std::optional<ModelError>>& list) {
    for (std::size_t i = 0; i < list.size(); ++i)
      if (list[i])
        rows.push_back({told_name(panel.outcomes[i]), fmt::format("{:.2f}", list[i]->psnr_db),
                        fmt::format("{:+.3f}", list[i]->psnr_db - list.front()->psnr_db),
                        fmt::format("{:.4f}", list[i]->ssim),
                        report.with_flip ? fmt::format("{:.4f}", list[i]->flip) : "–"});
  };
  add(report.study.drawing, report.drawing_model);
  add(report.study.antialiasing, report.antialiasing_model);
  page.table(
      {{"configuration", Column::text}, {"PSNR dB"}, {"against the defaults"}, {"SSIM"}, {"FLIP"}},
      rows);
}

}  // namespace

std::string tradeoff_page(const TradeoffReport& report, const std::vector<DrawnFigure>& figures) {
  const Study& study = report.study;
  HtmlPage page("Error against run time: " + report.scene.name);
  page.paragraph(choice_sentence(report));
  add_facts(page, report);
  if (figures.empty()) page.paragraph(gnuplot_missing);
  for (const DrawnFigure& figure : figures) page.drawing(figure.svg, figure.caption);
  page.section("Drawing knobs");
  page.paragraph(fmt::format(
      "E_render: against the oracle's picture of the same model, {}. Exact dB: against exact "
      "triangles, where the device's subpixel grid alone has {:.2f} dB; no knob changes that. R1, "
      "the reference rounded to 8 bits a channel, has {:.2f} dB.",
      where_it_looks(report), study.grid.psnr_db, study.drawing.ideal.psnr_db));
  add_ranges(page, study.drawing);
  add_panel(page, report, study.drawing);
  page.section("Antialiasing knobs");
  page.paragraph(
      fmt::format("E_render against the oracle with 8 x 8 samples a pixel; R1 has {:.2f} dB.",
                  study.antialiasing.ideal.psnr_db));
  add_ranges(page, study.antialiasing);
  add_panel(page, report, study.antialiasing);
  add_model(page, report);
  return page.text();
}

}  // namespace tureen::cli
