#include "jobs/timing/pass_times.hpp"

#include <cassert>
#include <cstdio>

#include "base/steady_seconds.hpp"
#include "runtime/gl/timer_query.hpp"

namespace tureen {

namespace {

/// Mean milliseconds a frame, from an idle device to an idle device.
double wall_ms(Renderer& renderer, std::span<const Camera> cameras, int repeats) {
  renderer.finish();
  const double start = steady_seconds();
  for (const Camera& camera : cameras) {
    for (int i = 0; i < repeats; ++i) renderer.draw({camera});
    renderer.finish();
  }
  return 1000 * (steady_seconds() - start) / (double(repeats) * double(cameras.size()));
}

}  // namespace

PassTimes believed(std::vector<std::pair<std::string, double>> passes, double wall_ms) {
  double sum = 0;
  for (const auto& [pass, ms] : passes) sum += ms;
  // Some devices round timestamps to a microsecond, and the two times are from different frames.
  constexpr double tolerance = 1.1, rounding_ms = 0.002;
  // Below this fraction of the wall time, the passes are the smaller part of the frame.
  constexpr double complete = 0.5;
  char text[240];
  // A sum of 0 means that the device's clock does not advance.
  if (sum > 0 && sum <= wall_ms * tolerance + rounding_ms * double(passes.size())) {
    if (sum >= wall_ms * complete)
      return {.ms = std::move(passes), .gap = {}, .reason = {}, .gpu_ms = sum};
    std::snprintf(text, sizeof text,
                  "the passes take %.3f ms of frames that take %.3f ms by the wall clock: the rest "
                  "is work of the processor, or the device's timers miss a part",
                  sum, wall_ms);
    return {.ms = std::move(passes), .gap = PassTimesGap::partial, .reason = text, .gpu_ms = sum};
  }
  std::snprintf(text, sizeof text,
                "the device's timers report %.3f ms for frames that take %.3f ms by the wall "
                "clock: only the processor's clock is used",
                sum, wall_ms);
  return {.ms = {}, .gap = PassTimesGap::exceeds_wall_clock, .reason = text, .gpu_ms = {}};
}

PassTimes time_passes(const gl::Context& context, Renderer& renderer,
                      std::span<const Camera> cameras, int repeats) {
  assert(!cameras.empty() && repeats > 0);
  if (const auto reason = gl::timers_mislead(context.capabilities()))
    return {.ms = {}, .gap = PassTimesGap::no_timers, .reason = *reason, .gpu_ms = {}};
  gl::PassTimer timer(context);
  renderer.time_passes(&timer);
  std::vector<gl::PassTimer::PassTime> passes;
  // After three disturbed attempts, a fourth is unlikely to succeed.
  for (int attempt = 0; attempt < 3 && passes.empty(); ++attempt) {
    for (const Camera& camera : cameras)
      for (int i = 0; i < repeats; ++i) renderer.draw({camera});
    renderer.finish();
    passes = timer.collect();
  }
  renderer.time_passes(nullptr);
  if (passes.empty())
    return {.ms = {},
            .gap = PassTimesGap::disturbed_clock,
            .reason = "the device's clock was disturbed: only the processor's clock is used",
            .gpu_ms = {}};
  std::vector<std::pair<std::string, double>> ms;
  for (const auto& each : passes)
    ms.emplace_back(each.pass, each.ms / (double(repeats) * double(cameras.size())));
  return believed(std::move(ms), wall_ms(renderer, cameras, repeats));
}

}  // namespace tureen
