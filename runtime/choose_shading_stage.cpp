#include "runtime/choose_shading_stage.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>

namespace tureen {

namespace {

constexpr int turns = 7;
// What waiting for a device costs, some hundredths of a millisecond, is little beside this.
constexpr double least_turn_ms = 2;
constexpr int most_passes = 32;

using Times = std::array<double, turns>;

class Stopwatch {
 public:
  explicit Stopwatch(const StageTiming& timing) : timing_(timing) {}

  /// Milliseconds of `passes` passes together.
  double time(ShadingStage stage, int passes) const {
    timing_.finish();
    const double start = now();
    for (int i = 0; i < passes; ++i) timing_.shade(stage);
    timing_.finish();
    return 1000 * (now() - start);
  }

 private:
  double now() const {
    if (timing_.clock) return timing_.clock();
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
  }

  const StageTiming& timing_;
};

}  // namespace

StageChoice choose_shading_stage(const StageTiming& timing) {
  const Stopwatch stopwatch(timing);
  stopwatch.time(ShadingStage::compute, 1);
  stopwatch.time(ShadingStage::fragment, 1);
  const double once = stopwatch.time(ShadingStage::fragment, 1);
  const int passes =
      once > 0 ? int(std::clamp(std::ceil(least_turn_ms / once), 1.0, double(most_passes)))
               : most_passes;

  Times fragment{}, compute{};
  for (std::size_t i = 0; i < turns; ++i) {
    fragment[i] = stopwatch.time(ShadingStage::fragment, passes) / passes;
    compute[i] = stopwatch.time(ShadingStage::compute, passes) / passes;
  }
  std::sort(fragment.begin(), fragment.end());
  std::sort(compute.begin(), compute.end());
  const auto spread = [](const Times& sorted) { return sorted[turns - 2] - sorted[1]; };
  StageChoice choice{.stage = ShadingStage::fragment,
                     .fragment_ms = fragment[turns / 2],
                     .compute_ms = compute[turns / 2],
                     .spread_ms = std::max(spread(fragment), spread(compute))};
  if (choice.compute_ms + choice.spread_ms < choice.fragment_ms)
    choice.stage = ShadingStage::compute;
  return choice;
}

std::string sentence_of(const StageChoice& choice) {
  const bool computes = choice.stage == ShadingStage::compute;
  char text[160];
  std::snprintf(text, sizeof text,
                computes ? "shading runs as compute: %.3g ms against %.3g ms in the fragment "
                           "stage, spread %.2g ms"
                         : "shading runs in the fragment stage: %.3g ms against %.3g ms as "
                           "compute, spread %.2g ms",
                computes ? choice.compute_ms : choice.fragment_ms,
                computes ? choice.fragment_ms : choice.compute_ms, choice.spread_ms);
  // The program around us may have set a locale.
  std::string sentence = text;
  for (std::size_t i = 1; i + 1 < sentence.size(); ++i)
    if (sentence[i] == ',' && sentence[i + 1] != ' ') sentence[i] = '.';
  return sentence;
}

}  // namespace tureen
