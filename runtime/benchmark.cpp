#include "runtime/benchmark.hpp"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <ctime>

namespace tureen {

namespace {

double steady_seconds() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}

/// One run of the protocol: what its steps share.
class Run {
 public:
  Run(std::span<const Entrant> entrants, std::span<const Camera> cameras,
      const BenchmarkOptions& options)
      : entrants_(entrants),
        cameras_(cameras),
        options_(options),
        clock_(options.clock ? options.clock : steady_seconds),
        start_(clock_()) {}

  BenchmarkResult result() {
    BenchmarkResult result;
    for (const Entrant& entrant : entrants_) result.entrants.push_back(warmed_up(entrant));
    choose_frames_per_sample();
    const bool self_test = options_.self_test == BenchmarkOptions::SelfTest::run;
    const std::size_t turns = entrants_.size() + (self_test ? 2 : 0);
    rounds_ = affordable_rounds(turns);
    samples_ = std::size_t(rounds_) * cameras_.size() * turns;
    if (self_test) {
      const std::vector<const Entrant*> twice(2, &entrants_.front());
      const std::vector<FrameTimes> times = measured(twice, 2.0 / double(turns));
      result.aa_spread = series_spread(times[0], times[1]);
    }
    std::vector<const Entrant*> all;
    for (const Entrant& entrant : entrants_) all.push_back(&entrant);
    std::vector<FrameTimes> times = measured(all, 1.0);
    for (std::size_t i = 0; i < times.size(); ++i) result.entrants[i].times = std::move(times[i]);
    result.rounds = int(result.entrants.front().times.rounds());
    result.frames_per_sample = frames_per_sample_;
    result.seconds = elapsed();
    return result;
  }

 private:
  double elapsed() const { return clock_() - start_; }

  /// Milliseconds a frame.
  double sample(const Entrant& entrant, const Camera& camera, int frames) const {
    entrant.finish();
    const double start = clock_();
    for (int i = 0; i < frames; ++i) entrant.draw(camera);
    entrant.finish();
    return 1000 * (clock_() - start) / frames;
  }

  bool is_stable(const std::vector<double>& ms) const {
    if (ms.size() < 3) return false;
    const auto [low, high] = std::minmax_element(ms.end() - 3, ms.end());
    return *high <= *low * (1 + options_.stable_within);
  }

  EntrantResult warmed_up(const Entrant& entrant) {
    EntrantResult result{.name = entrant.name, .times = {}, .warm_up_frames = 0, .stable = false};
    const double start = clock_();
    std::vector<double> ms;
    const auto most = std::size_t(std::max(options_.most_warm_up_frames, 1));
    const auto least =
        std::clamp(std::size_t(std::max(options_.least_warm_up_frames, 1)), std::size_t(1), most);
    while (
        ms.size() < least || clock_() - start < options_.least_warm_up_seconds ||
        (ms.size() < most && !is_stable(ms) && clock_() - start < options_.most_warm_up_seconds)) {
      ms.push_back(sample(entrant, cameras_.front(), 1));
      report(0);
    }
    result.warm_up_frames = int(ms.size());
    result.stable = is_stable(ms);
    warm_ms_.push_back(*std::min_element(ms.begin(), ms.end()));
    return result;
  }

  void choose_frames_per_sample() {
    const double fastest = *std::min_element(warm_ms_.begin(), warm_ms_.end());
    if (options_.least_sample_ms <= 0) return;
    const double most = std::max(options_.most_frames_per_sample, 1);
    // A clock too coarse to see a frame gives 0, and the most.
    const double wanted = fastest > 0 ? options_.least_sample_ms / fastest : most;
    frames_per_sample_ = int(std::clamp(std::ceil(wanted), 1.0, most));
  }

  int affordable_rounds(std::size_t turns) const {
    assert(turns >= entrants_.size());
    if (options_.most_seconds <= 0) return options_.rounds;
    double frame = 0;
    for (const double ms : warm_ms_) frame += ms;
    frame += double(turns - entrants_.size()) * warm_ms_.front();
    const double round = frame * double(cameras_.size()) * frames_per_sample_ / 1000;
    const double left = options_.most_seconds - elapsed();
    return std::clamp(round > 0 ? int(std::min(left / round, 1e6)) : options_.rounds, 1,
                      options_.rounds);
  }

  /// Rounds of these entrants taking turns, until all are made or the share of the time that is
  /// theirs is used up.
  std::vector<FrameTimes> measured(const std::vector<const Entrant*>& entrants, double share) {
    std::vector<FrameTimes> times(entrants.size(), {.views = cameras_.size(), .ms = {}});
    const double begin = elapsed();
    const double limit = options_.most_seconds > 0
                             ? begin + std::max(options_.most_seconds - begin, 0.0) * share
                             : 0;
    for (int round = 0; round < rounds_; ++round) {
      if (limit > 0 && round > 0) {
        const double each = (elapsed() - begin) / round;
        if (elapsed() + each > limit) break;
      }
      for (const Camera& camera : cameras_)
        for (std::size_t i = 0; i < entrants.size(); ++i) {
          times[i].ms.push_back(sample(*entrants[i], camera, frames_per_sample_));
          report(double(++samples_done_) / double(samples_));
        }
    }
    return times;
  }

  void report(double fraction) const {
    if (options_.progress) options_.progress(fraction);
  }

  std::span<const Entrant> entrants_;
  std::span<const Camera> cameras_;
  const BenchmarkOptions& options_;
  std::function<double()> clock_;
  double start_;
  std::vector<double> warm_ms_;  // the fastest warm-up frame of each entrant
  int frames_per_sample_ = 1;
  int rounds_ = 1;
  std::size_t samples_ = 1, samples_done_ = 0;
};

}  // namespace

double processor_seconds() { return double(std::clock()) / CLOCKS_PER_SEC; }

BenchmarkResult run_benchmark(std::span<const Entrant> entrants, std::span<const Camera> cameras,
                              const BenchmarkOptions& options) {
  assert(!entrants.empty() && !cameras.empty() && options.rounds > 0);
  return Run(entrants, cameras, options).result();
}

}  // namespace tureen
