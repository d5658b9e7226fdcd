#include "cli/tradeoff_scenes_page.hpp"

#include <fmt/format.h>

#include "cli/gnuplot.hpp"
#include "cli/html_page.hpp"
#include "cli/tradeoff_scenes_report.hpp"

namespace tureen::cli {

namespace {

using Column = HtmlPage::Column;

void add_scenes(HtmlPage& page, const TradeoffScenes& scenes) {
  std::vector<std::vector<std::string>> rows;
  for (std::size_t r = 0; r < scenes.runs.size(); ++r) {
    const TradeoffReport& report = scenes.runs[r].report;
    rows.push_back({scenes.labels[r], scenes.runs[r].file, counted(report.scene.triangles),
                    report.scene.appearance,
                    fmt::format("{} of {} x {} ({})", report.views, report.width, report.height,
                                report.camera_set),
                    report.device.renderer + (report.device.software ? " (software)" : ""),
                    report.clock, report.date});
  }
  page.table({{"scene", Column::text},
              {"file", Column::text},
              {"triangles"},
              {"appearance", Column::text},
              {"views", Column::text},
              {"device", Column::text},
              {"times", Column::text},
              {"measured", Column::text}},
             rows);
}

void add_means(HtmlPage& page, const TradeoffScenes& scenes, const ScenesPanel& panel) {
  std::vector<HtmlPage::Heading> headings{{"configuration", Column::text},
                                          {"drawn by", Column::text},
                                          {"time"},
                                          {"ms"},
                                          {"p95 ms"},
                                          {"mean dB"},
                                          {"worst dB"},
                                          {"worst in", Column::text},
                                          {"coverage"},
                                          {"", Column::text}};
  std::vector<std::vector<std::string>> rows;
  for (std::size_t i = 0; i < panel.means.outcomes.size(); ++i) {
    const Outcome& mean = panel.means.outcomes[i];
    const auto timed = [&](double value, int digits) {
      return mean.has_time() ? fmt::format("{:.{}f}", value, digits) : std::string("–");
    };
    rows.push_back({mean.name, name_of(mean.method), timed(time_ratio(panel.means, i), 3),
                    timed(mean.ms.min_of_medians, 2), timed(mean.ms.p95, 2),
                    fmt::format("{:.2f}", mean.error.psnr_db),
                    fmt::format("{:.2f}", mean.error.worst_psnr_db), worst_scene(scenes, mean),
                    fmt::format("{:.1e}", mean.error.coverage_mismatch),
                    is_on_front(panel.means, i) ? "front" : ""});
  }
  page.table(headings, rows);
  page.paragraph(summary(panel));
  page.list(left_out_lines(scenes, panel));
}

/// Time and decibels in each scene.
void add_members(HtmlPage& page, const TradeoffScenes& scenes, const ScenesPanel& panel) {
  std::vector<HtmlPage::Heading> headings{{"configuration", Column::text},
                                          {"drawn by", Column::text}};
  for (const std::string& label : scenes.labels) {
    headings.push_back({label + ", time"});
    headings.push_back({"dB"});
  }
  std::vector<std::vector<std::string>> rows;
  for (std::size_t i = 0; i < panel.means.outcomes.size(); ++i) {
    const Outcome& mean = panel.means.outcomes[i];
    std::vector<std::string> row{mean.name, name_of(mean.method)};
    for (std::size_t r = 0; r < scenes.runs.size(); ++r) {
      const Panel& own = own_panel(scenes, panel, r);
      const std::size_t member = panel.members[i][r];
      row.push_back(mean.has_time() ? fmt::format("{:.3f}", time_ratio(own, member)) : "–");
      row.push_back(fmt::format("{:.2f}", own.outcomes[member].error.psnr_db));
    }
    rows.push_back(std::move(row));
  }
  page.fold("Scene by scene");
  page.table(headings, rows);
  page.fold_end();
}

}  // namespace

std::string tradeoff_scenes_page(const TradeoffScenes& scenes,
                                 const std::vector<DrawnFigure>& means,
                                 const std::vector<DrawnFigure>& of_scenes) {
  HtmlPage page(fmt::format("Error against run time over {} scenes", scenes.runs.size()));
  page.paragraph(
      "What a way to draw costs and gains on the whole: the geometric mean over the scenes of its "
      "time relative to each scene's defaults, and the mean of the decibels, which is the PSNR of "
      "the geometric mean of the squared errors. Only what was measured of all scenes has a mean.");
  add_scenes(page, scenes);
  std::vector<std::string> notes = scenes.notes;
  std::erase(notes, gnuplot_missing);  // said below, where the plots would be
  page.list(notes);
  std::string line = "tureen";
  for (const std::string& argument : scenes.program.arguments) line += " " + argument;
  page.command(line);
  if (means.empty()) page.paragraph(gnuplot_missing);
  for (const DrawnFigure& figure : means) page.drawing(figure.svg, figure.caption);
  page.section("Drawing knobs");
  page.paragraph(fmt::format("E_render: against the oracle's pictures of the same models, {}.",
                             where_it_looks(scenes.runs.front().report)));
  add_means(page, scenes, scenes.drawing);
  add_members(page, scenes, scenes.drawing);
  page.section("Antialiasing knobs");
  page.paragraph("E_render against the oracle with 8 x 8 samples a pixel.");
  add_means(page, scenes, scenes.antialiasing);
  add_members(page, scenes, scenes.antialiasing);
  if (!of_scenes.empty()) {
    page.section("The scenes");
    for (const DrawnFigure& figure : of_scenes) page.drawing(figure.svg, figure.caption);
  }
  return page.text();
}

}  // namespace tureen::cli
