// The timing protocol, with simulated cases and a simulated clock.
#include "jobs/timing/benchmark.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

namespace tureen {
namespace benchmark_test {

using testing::Each;
using testing::ElementsAre;

/// A device whose clock advances only for drawing: draw() queues work, finish() does it.
struct Machine {
  double seconds = 0;
  double pending = 0;
  std::string log;  // the names of the cases, one per frame; '|' for each finish()

  BenchmarkCase benchmark_case(const std::string& name,
                               std::function<double(const Camera&)> frame_ms) {
    return {.name = name,
            .draw =
                [this, name, frame_ms = std::move(frame_ms)](const FrameInput& input) {
                  pending += frame_ms(input.camera) / 1000;
                  log += name;
                },
            .finish =
                [this] {
                  seconds += pending;
                  pending = 0;
                  log += '|';
                }};
  }
  BenchmarkOptions options(int rounds) {
    return {.rounds = rounds, .clock = [this] { return seconds; }};
  }
};

std::function<double(const Camera&)> always(double ms) {
  return [ms](const Camera&) { return ms; };
}

std::vector<Camera> cameras(int count) {
  std::vector<Camera> result(std::size_t(count), Camera{});
  for (int i = 0; i < count; ++i) result[std::size_t(i)].width = i + 1;
  return result;
}

TEST(Benchmark, CasesTakeTurnsAfterTheFirstHasMetItself) {
  Machine machine;
  const std::vector<BenchmarkCase> cases{machine.benchmark_case("A", always(1)),
                                         machine.benchmark_case("B", always(2))};
  run_benchmark(cases, cameras(2), machine.options(2));
  // Three frames of warm-up per case. Then, for two views in each of two rounds: A A, then A B.
  EXPECT_EQ(machine.log,
            "|A||A||A|"
            "|B||B||B|"
            "|A||A||A||A|"
            "|A||A||A||A|"
            "|A||B||A||B|"
            "|A||B||A||B|");
}

TEST(Benchmark, FramesAreTimedToTheirEndViewByView) {
  Machine machine;
  const std::vector<BenchmarkCase> cases{
      machine.benchmark_case("A", [](const Camera& camera) { return 10.0 * camera.width; }),
      machine.benchmark_case("B", always(5))};
  const BenchmarkResult result = run_benchmark(cases, cameras(3), machine.options(2));
  EXPECT_EQ(result.rounds, 2);
  EXPECT_EQ(result.frames_per_sample, 1);
  EXPECT_NEAR(result.aa_spread, 0, 1e-12);
  ASSERT_EQ(result.cases.size(), 2u);
  EXPECT_EQ(result.cases[0].name, "A");
  EXPECT_TRUE(result.cases[0].stable);
  EXPECT_EQ(result.cases[0].times.views, 3u);
  // Differences between clock readings in doubles are rounded.
  using testing::DoubleNear;
  EXPECT_THAT(result.cases[0].times.ms,
              ElementsAre(DoubleNear(10, 1e-9), DoubleNear(20, 1e-9), DoubleNear(30, 1e-9),
                          DoubleNear(10, 1e-9), DoubleNear(20, 1e-9), DoubleNear(30, 1e-9)));
  EXPECT_THAT(result.cases[1].times.ms, Each(DoubleNear(5, 1e-9)));
}

TEST(Benchmark, WarmUpLastsUntilTheTimesAreStable) {
  Machine machine;
  int frame = 0;
  const std::vector<BenchmarkCase> cases{machine.benchmark_case(
      "A", [&](const Camera&) { return ++frame <= 6 ? 100.0 / frame : 10.0; })};
  const BenchmarkResult result = run_benchmark(cases, cameras(1), machine.options(1));
  EXPECT_EQ(result.cases[0].warm_up_frames, 9);  // six with falling times, three equal
  EXPECT_TRUE(result.cases[0].stable);
}

TEST(Benchmark, AWarmUpThatNeverComesToRestEndsAndSaysSo) {
  Machine machine;
  int frame = 0;
  const std::vector<BenchmarkCase> cases{
      machine.benchmark_case("A", [&](const Camera&) { return ++frame % 2 ? 10.0 : 20.0; })};
  BenchmarkOptions options = machine.options(1);
  options.max_warm_up_frames = 12;
  const BenchmarkResult result = run_benchmark(cases, cameras(1), options);
  EXPECT_EQ(result.cases[0].warm_up_frames, 12);
  EXPECT_FALSE(result.cases[0].stable);
  EXPECT_NEAR(result.aa_spread, 1.0, 1e-9);  // 10 against 20
}

TEST(Benchmark, WarmUpHasATimeLimitToo) {
  Machine machine;
  int frame = 0;
  const std::vector<BenchmarkCase> cases{
      machine.benchmark_case("A", [&](const Camera&) { return ++frame % 2 ? 1000.0 : 2000.0; })};
  BenchmarkOptions options = machine.options(1);
  options.max_warm_up_seconds = 4.5;
  EXPECT_EQ(run_benchmark(cases, cameras(1), options).cases[0].warm_up_frames, 4);
}

TEST(Benchmark, WarmUpCanBeMadeToLast) {
  Machine machine;
  const std::vector<BenchmarkCase> cases{machine.benchmark_case("A", always(1))};
  BenchmarkOptions options = machine.options(1);
  options.min_warm_up_seconds = 0.25;
  options.max_warm_up_frames = 20;
  // With a clock in doubles, one frame more may be needed.
  EXPECT_NEAR(run_benchmark(cases, cameras(1), options).cases[0].warm_up_frames, 250, 1);
}

TEST(Benchmark, FastFramesShareASampleAndEverybodyDrawsAsMany) {
  Machine machine;
  const std::vector<BenchmarkCase> cases{machine.benchmark_case("A", always(8)),
                                         machine.benchmark_case("B", always(0.5))};
  BenchmarkOptions options = machine.options(1);
  options.self_test = BenchmarkOptions::SelfTest::skip;
  options.min_sample_ms = 2;
  const BenchmarkResult result = run_benchmark(cases, cameras(1), options);
  EXPECT_EQ(result.frames_per_sample, 4);
  EXPECT_EQ(machine.log.substr(machine.log.size() - 12), "|AAAA||BBBB|");
  EXPECT_NEAR(result.cases[0].times.ms[0], 8, 1e-9);
  EXPECT_NEAR(result.cases[1].times.ms[0], 0.5, 1e-9);
  EXPECT_EQ(result.aa_spread, 0);

  options.max_frames_per_sample = 3;
  EXPECT_EQ(run_benchmark(cases, cameras(1), options).frames_per_sample, 3);
}

TEST(Benchmark, TimeThatIsUpEndsItAfterWholeRounds) {
  Machine machine;
  const std::vector<BenchmarkCase> cases{machine.benchmark_case("A", always(100)),
                                         machine.benchmark_case("B", always(100))};
  BenchmarkOptions options = machine.options(1000);
  options.max_seconds = 5;
  const BenchmarkResult result = run_benchmark(cases, cameras(3), options);
  // 0.6 s of warm-up; a round with all four frames per view takes 1.2 s.
  EXPECT_EQ(result.rounds, 3);
  EXPECT_EQ(result.cases[1].times.ms.size(), 9u);
  EXPECT_LE(result.seconds, 5);

  options.max_seconds = 0.01;
  EXPECT_EQ(run_benchmark(cases, cameras(3), options).rounds, 1);
}

TEST(Benchmark, ProgressGrowsToTheEndAndMayAbandon) {
  Machine machine;
  const std::vector<BenchmarkCase> cases{machine.benchmark_case("A", always(1))};
  BenchmarkOptions options = machine.options(3);
  double last = 0;
  options.progress = [&](double fraction) {
    EXPECT_GE(fraction, last);
    last = fraction;
  };
  run_benchmark(cases, cameras(2), options);
  EXPECT_DOUBLE_EQ(last, 1);

  options.progress = [](double) { throw std::runtime_error("enough"); };
  EXPECT_THROW(run_benchmark(cases, cameras(2), options), std::runtime_error);
}

TEST(Benchmark, ProcessorTimePassesWithWorkAndNotWithWaiting) {
  const double start = processor_seconds();
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  const double waited = processor_seconds();
#ifndef _WIN32  // there it returns wall-clock time
  EXPECT_LT(waited - start, 0.05);
#endif
  double worked = waited;
  while (worked < waited + 0.01) worked = processor_seconds();  // endless otherwise
  EXPECT_GE(waited, start);
}

}  // namespace benchmark_test
}  // namespace tureen
