#include "cli/bench_markdown.hpp"

#include <fmt/format.h>

#include "cli/bench_plots.hpp"

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
      "{}, {} triangles; {}{}, {}, {} cores; commit {}, {}. Times: "
      "{}.\n\n",
      markdown_cell(result.scene.name), counted(result.scene.triangles),
      markdown_cell(result.device.renderer), result.device.software ? " (software)" : "",
      markdown_cell(result.machine.cpu), result.machine.cores, markdown_cell(result.program.commit),
      result.date, markdown_cell(result.protocol.clock));
  text += fmt::format(
      "| cameras | size | configuration | median ms | best ms | p95 ms | p99 ms | FPS | 1 % low | "
      "A/A spread | times as fast as {} |\n|---|---|---|---|---|---|---|---|---|---|---|\n",
      markdown_cell(reference_configuration(result)));
  for (const BenchMeasurement& m : result.measurements) {
    const double ratio = times_as_fast(result, m);
    text += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {:.1f} | {:.1f} | {:.1f} % | {} |\n",
                        markdown_cell(m.camera_set), markdown_cell(m.size),
                        markdown_cell(m.configuration), ms(m.frame_ms.median),
                        ms(m.frame_ms.min_of_medians), ms(m.frame_ms.p95), ms(m.frame_ms.p99),
                        m.fps, m.frame_ms.low_1_percent_fps, 100 * m.aa_spread,
                        ratio > 0 ? fmt::format("{:.2f}", ratio) : "");
  }
  return text;
}

}  // namespace tureen::cli
