#include "cli/bench_markdown.hpp"

#include <fmt/format.h>

#include "cli/bench_words.hpp"

namespace tureen::cli {

namespace {

std::string ms(double value) { return fmt::format("{:.{}f}", value, value < 10 ? 3 : 1); }

}  // namespace

std::string markdown_cell(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '|' || c == '\\' || c == '<' || c == '*' || c == '`' || c == '_') result += '\\';
    result += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return result;
}

std::string bench_markdown(const BenchResult& result) {
  std::string text = fmt::format(
      "{}, {} triangles; {}{}, {}; {}, {}. Times: {}. {}\n\n", markdown_cell(result.scene.name),
      counted(result.scene.triangles), markdown_cell(result.device.renderer),
      result.device.software ? " (software)" : "", markdown_cell(machine_text(result.machine)),
      markdown_cell(build_text(result.program)), result.date, markdown_cell(result.protocol.clock),
      ratio_sentence);
  text += fmt::format(
      "| cameras | size | configuration | rounds | frames | median ms | best ms | p95 ms | p99 ms "
      "| "
      "FPS | 1 % low | A/A spread | spread | times as fast as {} |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
      markdown_cell(reference_configuration(result)));
  bool restless = false;
  for (const BenchMeasurement& m : result.measurements) {
    const FrameStatistics& times = m.frame_ms;
    restless |= !m.stable;
    text += fmt::format(
        "| {} | {} | {}{} | {} | {} | {} | {} | {} | {} | {:.1f} | {} | {:.1f} % | {} | {} |\n",
        markdown_cell(m.camera_set), markdown_cell(m.size), markdown_cell(m.configuration),
        m.stable ? "" : restless_mark, times.rounds, m.frames, ms(times.median),
        ms(times.min_of_medians), ms(times.p95), slowest_percent_text(times, ms(times.p99)), m.fps,
        slowest_percent_text(times, fmt::format("{:.1f}", times.low_1_percent_fps)),
        100 * m.aa_spread, spread_text(times), times_as_fast_text(result, m));
  }
  if (restless) text += std::string("\n") + restless_sentence + "\n";
  return text;
}

std::string comparison_markdown(const BenchComparison& comparison, const std::string& against) {
  std::string text = "\nAgainst " + markdown_cell(against) + ":";
  text += comparison.ratios.empty() ? " nothing can be compared.\n"
                                    : "\n\n| configuration | cameras | size | ms then | ms now | "
                                      "times as long | spread | verdict "
                                      "|\n|---|---|---|---|---|---|---|---|\n";
  for (const BenchRatio& ratio : comparison.ratios)
    text += fmt::format("| {} | {} | {} | {} | {} | {:.3f} | {} | {}{} |\n",
                        markdown_cell(ratio.configuration), markdown_cell(ratio.camera_set),
                        markdown_cell(ratio.size), ms(ratio.then_ms), ms(ratio.now_ms), ratio.ratio,
                        ratio.spread ? fmt::format("{:.1f} %", 100 * *ratio.spread) : not_known,
                        verdict_text(ratio.verdict, ratio.rounds),
                        ratio.same_pixels ? "" : "; another picture");
  std::string list;
  for (const auto* sentences : {&comparison.circumstances, &comparison.unmatched})
    for (const std::string& sentence : *sentences) list += "- " + markdown_cell(sentence) + "\n";
  return text + (list.empty() ? "" : "\n" + list);
}

}  // namespace tureen::cli
