#include "cli/bench_page.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cli/bench_words.hpp"
#include "cli/html_page.hpp"

namespace tureen::cli {

namespace {

using Column = HtmlPage::Column;

std::string ms(double value) { return fmt::format("{:.{}f}", value, value < 10 ? 3 : 1); }

std::string percent(double fraction) { return fmt::format("{:.1f} %", 100 * fraction); }

std::string shell_line(const std::vector<std::string>& words) {
  std::string line = "tureen";
  for (const std::string& word : words) {
    const bool plain = !word.empty() && word.find_first_not_of(
                                            "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWX"
                                            "YZ0123456789-_./:,=@+%") == std::string::npos;
    line += plain ? " " + word : " '";
    if (plain) continue;
    for (const char c : word) line += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += "'";
  }
  return line;
}

void measurements(HtmlPage& page, const BenchResult& result) {
  page.section("Frame times");
  page.paragraph(fmt::format(
      "Milliseconds a frame. Configurations took turns frame by frame; \"best\" is the smallest "
      "of the rounds' medians, of which the ratios to '{}' are taken; {} The A/A spread is one "
      "configuration measured against itself. FPS is 1000 divided by the mean.",
      reference_configuration(result), ratio_sentence));
  if (result.device.software)
    page.paragraph(
        "The device is a software rasteriser: these times say nothing about graphics hardware.");
  std::vector<std::vector<std::string>> rows;
  for (const BenchMeasurement& m : result.measurements) {
    const FrameStatistics& times = m.frame_ms;
    rows.push_back({m.configuration, m.camera_set, m.size, fmt::format("{}x{}", m.width, m.height),
                    counted(std::uint64_t(times.rounds)), counted(std::uint64_t(m.frames)),
                    ms(times.median), ms(times.min_of_medians), ms(times.p95),
                    slowest_percent_text(times, ms(times.p99)), fmt::format("{:.1f}", m.fps),
                    slowest_percent_text(times, fmt::format("{:.1f}", times.low_1_percent_fps)),
                    percent(m.aa_spread), spread_text(times), times_as_fast_text(result, m),
                    m.gpu_ms ? ms(*m.gpu_ms) : "",
                    m.stable ? "" : "its warm-up had not come to rest"});
  }
  page.table({{"configuration", Column::text},
              {"cameras", Column::text},
              {"size", Column::text},
              {"pixels"},
              {"rounds"},
              {"frames"},
              {"median"},
              {"best"},
              {"p95"},
              {"p99"},
              {"FPS"},
              {"1 % low"},
              {"A/A spread"},
              {"spread"},
              {"times as fast"},
              {"GPU"},
              {"", Column::text}},
             rows);
}

void passes(HtmlPage& page, const BenchResult& result) {
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> reasons;
  for (const BenchMeasurement& m : result.measurements) {
    std::string parts;
    for (const auto& [name, time] : m.passes_ms)
      parts += fmt::format("{}{} {}", parts.empty() ? "" : ", ", name, ms(time));
    if (!parts.empty()) {
      if (!m.passes_reason.empty()) parts += " (" + m.passes_reason + ")";
      rows.push_back({m.configuration, m.camera_set, m.size, parts});
    } else if (!m.passes_reason.empty() &&
               std::find(reasons.begin(), reasons.end(), m.passes_reason) == reasons.end()) {
      reasons.push_back(m.passes_reason);
    }
  }
  if (rows.empty() && reasons.empty()) return;
  page.section("Passes");
  if (!rows.empty())
    page.table({{"configuration", Column::text},
                {"cameras", Column::text},
                {"size", Column::text},
                {"milliseconds by the device's own clock", Column::text}},
               rows);
  page.list(reasons);
}

void comparison(HtmlPage& page, const BenchPage& extra) {
  if (!extra.comparison) return;
  page.section("Against " + extra.compared_with);
  page.list(extra.comparison->circumstances);
  if (extra.comparison->ratios.empty()) page.paragraph("Nothing can be compared.");
  std::vector<std::vector<std::string>> rows;
  for (const BenchRatio& r : extra.comparison->ratios)
    rows.push_back({r.configuration, r.camera_set, r.size, ms(r.then_ms), ms(r.now_ms),
                    fmt::format("{:.3f}", r.ratio), r.spread ? percent(*r.spread) : not_known,
                    verdict_text(r.verdict, r.rounds), r.same_pixels ? "the same" : "another"});
  if (!rows.empty())
    page.table({{"configuration", Column::text},
                {"cameras", Column::text},
                {"size", Column::text},
                {"then ms"},
                {"now ms"},
                {"now / then"},
                {"spread"},
                {"by twice the spread", Column::text},
                {"picture", Column::text}},
               rows);
  page.list(extra.comparison->unmatched);
}

void load(HtmlPage& page, const BenchResult& result) {
  page.section("Before the first frame");
  page.facts(
      {{"reading the file", ms(result.load.read_ms) + " ms"},
       {"the plan", ms(result.load.plan_ms) + " ms"},
       {"upload and shaders", ms(result.load.upload_ms) + " ms"},
       {"peak memory of the process",
        result.load.peak_mib > 0 ? fmt::format("{:.0f} MiB", result.load.peak_mib) : not_known},
       {"and after all measurements",
        result.peak_mib ? fmt::format("{:.0f} MiB", *result.peak_mib) : not_known},
       {"memory on the device", fmt::format("{:.1f} MiB", result.load.device_mib)}});
}

void plans(HtmlPage& page, const BenchResult& result) {
  page.section("Configurations and their plans");
  for (const BenchConfiguration& configuration : result.configurations) {
    std::string options;
    for (const std::string& option : configuration.options) options += " " + option;
    page.paragraph(configuration.name + (options.empty() ? "" : " (tureen render" + options + ")") +
                   fmt::format(": {:.1f} MiB on the device, {} ms of analysis, {} ms of upload",
                               configuration.device_mib, ms(configuration.plan_ms),
                               ms(configuration.upload_ms)));
    page.list(configuration.plan);
  }
}

void circumstances(HtmlPage& page, const BenchResult& result) {
  page.section("Where and how");
  page.facts(
      {{"scene", fmt::format("{} ({}), {} triangles, {}", result.scene.name, result.scene.path,
                             counted(result.scene.triangles), result.scene.appearance)},
       {"machine",
        fmt::format("{}, {:.0f} MiB", machine_text(result.machine), result.machine.memory_mib)},
       {"renderer", result.device.renderer + (result.device.software ? ", software" : "")},
       {"vendor", result.device.vendor},
       {"driver", result.device.version},
       {"context", result.device.context},
       {"program",
        fmt::format("tureen {}, {}", result.program.version, build_text(result.program))},
       {"date", result.date},
       {"clock", result.protocol.clock},
       {"rounds", fmt::format("{}", result.protocol.rounds)},
       {"largest A/A spread", percent(result.protocol.aa_spread)}});
  page.command(shell_line(result.program.arguments));
  page.list(result.notes);
}

}  // namespace

std::string bench_page(const BenchResult& result, const BenchPage& extra) {
  HtmlPage page(result.scene.name + ": frame times");
  page.paragraph(fmt::format("{} triangles on {}, {}.", counted(result.scene.triangles),
                             result.device.renderer, result.date));
  for (const DrawnFigure& figure : extra.figures) page.drawing(figure.svg, figure.caption);
  if (!extra.missing.empty()) page.paragraph(extra.missing);
  measurements(page, result);
  comparison(page, extra);
  passes(page, result);
  load(page, result);
  plans(page, result);
  circumstances(page, result);
  if (!extra.pictures.empty()) page.section("Frames that were timed");
  for (const BenchPage::Picture& picture : extra.pictures)
    page.picture(picture.png, picture.caption);
  return page.text();
}

}  // namespace tureen::cli
