#include "cli/bench/bench_table.hpp"

#include <fmt/format.h>

#include <set>

#include "cli/measuring/bench_words.hpp"
#include "cli/table.hpp"
#include "scene/scene.hpp"

namespace tureen::cli {

namespace {

std::string fps_text(double fps) { return fmt::format("{:.{}f}", fps, fps < 100 ? 1 : 0); }

bool same_views(const BenchMeasurement& a, const BenchMeasurement& b) {
  return a.camera_set == b.camera_set && a.size == b.size;
}

std::string compared(const BenchMeasurement& each, const BenchMeasurement& first) {
  if (&each == &first) return "1.00";
  return ratio_text(each.frame_ms.min_of_medians / first.frame_ms.min_of_medians, each, first);
}

std::string passes_text(const BenchMeasurement& measurement) {
  std::string text;
  for (const auto& [pass, ms] : measurement.passes_ms)
    text += fmt::format("{}{} {} ms", text.empty() ? "" : ", ", pass, ms_text(ms));
  return text;
}

void add_heading(std::vector<std::string>& lines, const BenchMeasurement& first) {
  std::string heading =
      fmt::format("{} x {}, {}: {}, {}", first.width, first.height, first.camera_set,
                  count_text(first.views, "view"), count_text(first.frame_ms.rounds, "round"));
  if (first.frames_per_sample > 1)
    heading += fmt::format(" of {} frames a view", first.frames_per_sample);
  lines.push_back("");
  lines.push_back(heading + fmt::format(", A/A spread {:.1f} %", 100 * first.aa_spread));
}

void add_row(Table& table, const BenchMeasurement& each, const BenchMeasurement& first) {
  const FrameStatistics& ms = each.frame_ms;
  table.row({each.configuration, ms_text(ms.min_of_medians), ms_text(ms.mean), ms_text(ms.median),
             ms_text(ms.p95), slowest_percent_text(ms, ms_text(ms.p99)), fps_text(each.fps),
             slowest_percent_text(ms, fps_text(ms.low_1_percent_fps)), compared(each, first)});
  if (!each.passes_ms.empty()) table.remark("times from the device's clock: " + passes_text(each));
  if (each.passes_gap == PassTimesGap::partial) table.remark(each.passes_reason);
  if (each.order_ms)
    table.remark(
        fmt::format("of these, the processor sorts splats for {} ms", ms_text(*each.order_ms)));
  if (!each.stable) table.remark("times were not stable after the warm-up");
}

/// Reasons for missing pass times: one line per kind of gap, with the numbers of its first
/// measurement.
void add_pass_gaps(std::vector<std::string>& lines, const BenchResult& result) {
  // One pass needs no explanation; a partial time has its reason below the row.
  std::set<PassTimesGap> explained{PassTimesGap::none, PassTimesGap::one_pass,
                                   PassTimesGap::partial};
  const std::size_t without = explained.size();
  for (const BenchMeasurement& each : result.measurements) {
    if (!explained.insert(each.passes_gap).second) continue;
    if (explained.size() == without + 1) lines.push_back("");
    lines.push_back("No pass times: " + each.passes_reason + ".");
  }
}

}  // namespace

std::vector<std::string> bench_table(const BenchResult& result) {
  std::vector<std::string> lines;
  lines.push_back(fmt::format(
      "{} ({}){}", result.device.renderer, result.device.context,
      result.device.software ? ": software renderer; do not compare with hardware" : ""));
  lines.push_back(machine_text(result.machine));
  if (const std::string& build = result.program.build; !build.empty() && build != "release")
    lines.push_back(
        "A " + build +
        " build: its checks slow down every frame. Do not compare its times with other builds.");
  const BenchLoad& load = result.load;
  std::string peaks;  // browsers report only the second
  if (load.peak_mib > 0)
    peaks += fmt::format("; peak {:.0f} MiB before the first frame", load.peak_mib);
  if (result.peak_mib) peaks += fmt::format("; peak {:.0f} MiB after all frames", *result.peak_mib);
  std::string sizes;  // unknown in browsers
  if (load.disk_mib > 0)
    sizes =
        fmt::format("{:.1f} MiB on disk, {:.1f} MiB in memory, ", load.disk_mib, load.memory_mib);
  lines.push_back(fmt::format(
      "{}: read {} ms, plan {} ms, upload {} ms{}; {}{:.1f} MiB on the device",
      primitives_text(result.scene.triangles, result.scene.splats), ms_text(load.read_ms),
      ms_text(load.plan_ms), ms_text(load.upload_ms), peaks, sizes, load.device_mib));
  lines.push_back("Times: " + result.protocol.clock);
  const std::vector<BenchMeasurement>& all = result.measurements;
  for (std::size_t i = 0; i < all.size();) {
    const BenchMeasurement& first = all[i];
    add_heading(lines, first);
    Table table(
        {"configuration", "best ms", "mean ms", "p50", "p95", "p99", "FPS", "1 % low", "ratio"});
    for (; i < all.size() && same_views(first, all[i]); ++i) add_row(table, all[i], first);
    for (const std::string& line : table.lines()) lines.push_back("  " + line);
  }
  add_pass_gaps(lines, result);
  return lines;
}

}  // namespace tureen::cli
