#include "jobs/timing/benchmark.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "base/steady_seconds.hpp"

namespace tureen {

namespace {

bool is_stable(const std::vector<double>& ms, double stable_within) {
  if (ms.size() < 3) return false;
  const auto [low, high] = std::minmax_element(ms.end() - 3, ms.end());
  return *high <= *low * (1 + stable_within);
}

}  // namespace

BenchmarkRun::BenchmarkRun(std::span<const BenchmarkCase> cases, std::span<const Camera> cameras,
                           const BenchmarkOptions& options)
    : cases_(cases.begin(), cases.end()),
      cameras_(cameras.begin(), cameras.end()),
      options_(options),
      clock_(options.clock ? options.clock : steady_seconds),
      start_(clock_()) {
  assert(!cases_.empty() && !cameras_.empty() && options_.rounds > 0);
  for (const BenchmarkCase& benchmark_case : cases_)
    result_.cases.push_back(
        {.name = benchmark_case.name, .times = {}, .warm_up_frames = 0, .stable = false});
}

bool BenchmarkRun::step() {
  switch (phase_) {
    case Phase::warm_up:
      warm_up();
      return true;
    case Phase::self_test:
      if (!measure_next()) end_self_test();
      return true;
    case Phase::measurement:
      if (!measure_next()) end();
      return phase_ != Phase::done;
    case Phase::done:
      return false;
  }
  return false;
}

BenchmarkResult BenchmarkRun::result() && {
  assert(phase_ == Phase::done);
  return std::move(result_);
}

double BenchmarkRun::elapsed() const { return clock_() - start_; }

double BenchmarkRun::sample(const BenchmarkCase& benchmark_case, const Camera& camera,
                            int frames) const {
  benchmark_case.finish();
  const double start = clock_();
  for (int i = 0; i < frames; ++i) benchmark_case.draw({camera});
  benchmark_case.finish();
  return 1000 * (clock_() - start) / frames;
}

bool BenchmarkRun::is_warm() const {
  const auto most = std::size_t(std::max(options_.max_warm_up_frames, 1));
  const auto least =
      std::clamp(std::size_t(std::max(options_.min_warm_up_frames, 1)), std::size_t(1), most);
  const double seconds = clock_() - warm_up_start_;
  if (warm_up_ms_.size() < least || seconds < options_.min_warm_up_seconds) return false;
  return warm_up_ms_.size() >= most || is_stable(warm_up_ms_, options_.stable_within) ||
         seconds >= options_.max_warm_up_seconds;
}

void BenchmarkRun::warm_up() {
  if (warm_up_ms_.empty()) warm_up_start_ = clock_();
  const std::size_t benchmark_case = fastest_ms_.size();
  warm_up_ms_.push_back(sample(cases_[benchmark_case], cameras_.front(), 1));
  report();
  if (!is_warm()) return;
  result_.cases[benchmark_case].warm_up_frames = int(warm_up_ms_.size());
  result_.cases[benchmark_case].stable = is_stable(warm_up_ms_, options_.stable_within);
  fastest_ms_.push_back(*std::min_element(warm_up_ms_.begin(), warm_up_ms_.end()));
  warm_up_ms_.clear();
  if (fastest_ms_.size() == cases_.size()) begin();
}

void BenchmarkRun::begin() {
  choose_frames_per_sample();
  const bool self_test = options_.self_test == BenchmarkOptions::SelfTest::run;
  const std::size_t turns = cases_.size() + (self_test ? 2 : 0);
  rounds_ = affordable_rounds(turns);
  samples_ = std::size_t(rounds_) * cameras_.size() * turns;
  if (self_test)
    begin_series(Phase::self_test, {0, 0}, 2.0 / double(turns));
  else
    begin_measurement();
}

void BenchmarkRun::begin_measurement() {
  std::vector<std::size_t> all(cases_.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
  begin_series(Phase::measurement, std::move(all), 1.0);
}

void BenchmarkRun::end_self_test() {
  result_.aa_spread = series_spread(series_.times[0], series_.times[1]);
  result_.self_test = std::move(series_.times);
  begin_measurement();
}

void BenchmarkRun::end() {
  for (std::size_t i = 0; i < cases_.size(); ++i)
    result_.cases[i].times = std::move(series_.times[i]);
  result_.rounds = int(result_.cases.front().times.rounds());
  result_.frames_per_sample = frames_per_sample_;
  result_.seconds = elapsed();
  phase_ = Phase::done;
}

void BenchmarkRun::choose_frames_per_sample() {
  const double fastest = *std::min_element(fastest_ms_.begin(), fastest_ms_.end());
  if (options_.min_sample_ms <= 0) return;
  const double most = std::max(options_.max_frames_per_sample, 1);
  // A clock too coarse for a single frame returns 0; then the maximum is used.
  const double wanted = fastest > 0 ? options_.min_sample_ms / fastest : most;
  frames_per_sample_ = int(std::clamp(std::ceil(wanted), 1.0, most));
}

int BenchmarkRun::affordable_rounds(std::size_t turns) const {
  assert(turns >= cases_.size());
  if (options_.max_seconds <= 0) return options_.rounds;
  double frame = 0;
  for (const double ms : fastest_ms_) frame += ms;
  frame += double(turns - cases_.size()) * fastest_ms_.front();
  const double round = frame * double(cameras_.size()) * frames_per_sample_ / 1000;
  const double left = options_.max_seconds - elapsed();
  return std::clamp(round > 0 ? int(std::min(left / round, 1e6)) : options_.rounds, 1,
                    options_.rounds);
}

void BenchmarkRun::begin_series(Phase phase, std::vector<std::size_t> cases, double share) {
  phase_ = phase;
  series_ = {};
  series_.times.resize(cases.size(), {.views = cameras_.size(), .ms = {}});
  series_.cases = std::move(cases);
  series_.begin = elapsed();
  if (options_.max_seconds > 0)
    series_.limit = series_.begin + std::max(options_.max_seconds - series_.begin, 0.0) * share;
}

bool BenchmarkRun::next_round_is_affordable() const {
  if (series_.round == rounds_) return false;
  if (!(series_.limit > 0) || series_.round == 0) return true;
  return elapsed() + (elapsed() - series_.begin) / series_.round <= series_.limit;
}

bool BenchmarkRun::measure_next() {
  Series& series = series_;
  if (series.turn == 0 && !next_round_is_affordable()) return false;
  const std::size_t benchmark_case = series.turn % series.cases.size();
  const Camera& camera = cameras_[series.turn / series.cases.size()];
  series.times[benchmark_case].ms.push_back(
      sample(cases_[series.cases[benchmark_case]], camera, frames_per_sample_));
  ++samples_done_;
  report();
  if (++series.turn < cameras_.size() * series.cases.size()) return true;
  series.turn = 0;
  ++series.round;
  return true;
}

double BenchmarkRun::fraction() const {
  return phase_ == Phase::warm_up ? 0 : double(samples_done_) / double(samples_);
}

void BenchmarkRun::report() const {
  if (options_.progress) options_.progress(fraction());
}

double processor_seconds() { return double(std::clock()) / CLOCKS_PER_SEC; }

BenchmarkResult run_benchmark(std::span<const BenchmarkCase> cases, std::span<const Camera> cameras,
                              const BenchmarkOptions& options) {
  BenchmarkRun run(cases, cameras, options);
  while (run.step()) {
  }
  return std::move(run).result();
}

}  // namespace tureen
