// The timing protocol for all frame times.
//
// Cases alternate frame by frame (A B C A B C ..), so that disturbances affect all alike. Each is
// warmed up until it is stable. At the beginning the first case runs against itself; the
// difference, the A/A spread, is noise. A sample begins with an idle device and ends when the
// device has finished. On fast devices it is several frames of one view, so that the wait does not
// dominate. By default the clock is the computer's steady clock; BenchmarkOptions::clock replaces
// it.
//
// This file is independent of GL. Cases are functions, so that tests can use an artificial clock,
// and other renderers can be compared.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "jobs/timing/frame_statistics.hpp"
#include "scene/frame_input.hpp"

namespace tureen {

/// One configuration of a benchmark. Its functions must only draw: no error queries, no read-back,
/// no presentation.
struct BenchmarkCase {
  std::string name;
  std::function<void(const FrameInput&)> draw;  // may return before the device has finished
  std::function<void()> finish;                 // waits for the device
};

struct BenchmarkOptions {
  /// Number of passes through all cameras, at least 1.
  int rounds = 5;
  /// Time limit in seconds from the start, including warm-up: a round does not begin if it is
  /// expected to end later. At least one round is run. Default 0: no limit.
  double max_seconds = 0;

  /// Shortest sample in milliseconds. The fastest case's frames are repeated to reach it, up to
  /// `max_frames_per_sample`; the other cases use the same number. Default 0: one frame per sample.
  double min_sample_ms = 0;
  int max_frames_per_sample = 100;

  /// Warm-up: frames of the first camera, until the last three times are within `stable_within` of
  /// their smallest. Warm-up never ends before both minimums are reached. After that, it ends when
  /// times are stable or a maximum is reached.
  int min_warm_up_frames = 3;
  int max_warm_up_frames = 100;
  double max_warm_up_seconds = 2;
  /// Shortest warm-up in seconds, even if stable: graphics cards raise their clocks under load.
  double min_warm_up_seconds = 0;
  /// A fraction. 5 % is far above the jitter of an idle machine and far below the cost of compiling
  /// shaders.
  double stable_within = 0.05;

  /// Whether the first case is first measured against itself. Without it aa_spread is 0.
  enum class SelfTest { run, skip };
  SelfTest self_test = SelfTest::run;

  /// Called after every sample with the fraction done; may throw to cancel.
  std::function<void(double)> progress = nullptr;
  /// A monotonic clock in seconds; default: the steady clock.
  std::function<double()> clock = nullptr;
};

struct CaseResult {
  std::string name;
  FrameTimes times;  // milliseconds a frame; the mean of a sample with several frames
  int warm_up_frames = 0;
  bool stable = false;  // whether the warm-up became stable
};

struct BenchmarkResult {
  std::vector<CaseResult> cases;      // in the order given
  double aa_spread = 0;               // series_spread of the first case against itself
  std::vector<FrameTimes> self_test;  // its two series; empty without it
  int rounds = 0;                     // completed; fewer than requested if max_seconds is too short
  int frames_per_sample = 1;
  double seconds = 0;  // total
};

/// A clock for BenchmarkOptions: processor time in seconds over all threads of this program. With a
/// software renderer other programs hardly affect it, so ratios can be measured on a busy machine.
/// Waiting threads cost nothing, so it is not the duration of a frame. It does not include GPU
/// time; on Windows it is wall time.
double processor_seconds();

/// The protocol step by step, for callers with other work in between: a web page must return its
/// thread to the browser to stay responsive.
class BenchmarkRun {
 public:
  /// Asserts cases, cameras and at least one round. Copies all arguments.
  BenchmarkRun(std::span<const BenchmarkCase> cases, std::span<const Camera> cameras,
               const BenchmarkOptions& options = {});

  /// Runs the next part: a warm-up, a sample or an intermediate step. Returns false after the last.
  bool step();
  /// The completed fraction of the samples, 0..1; 0 during warm-up.
  double fraction() const;
  /// Valid after step() has returned false.
  BenchmarkResult result() &&;

 private:
  enum class Phase { warm_up, self_test, measurement, done };
  /// Rounds of alternating cases, until all are complete or their share of the time is used up.
  struct Series {
    std::vector<std::size_t> cases;
    std::vector<FrameTimes> times;  // one per case
    double begin = 0, limit = 0;    // seconds since the start; 0: no limit
    int round = 0;
    std::size_t turn = 0;  // within the round
  };

  double elapsed() const;
  double sample(const BenchmarkCase& benchmark_case, const Camera& camera,
                int frames) const;  // ms per frame
  bool is_warm() const;
  void warm_up();
  void begin();
  void begin_measurement();
  void end_self_test();
  void end();
  void choose_frames_per_sample();
  int affordable_rounds(std::size_t turns) const;
  void begin_series(Phase phase, std::vector<std::size_t> cases, double share);
  bool next_round_is_affordable() const;
  bool measure_next();
  void report() const;

  std::vector<BenchmarkCase> cases_;
  std::vector<Camera> cameras_;
  BenchmarkOptions options_;
  std::function<double()> clock_;
  double start_;
  Phase phase_ = Phase::warm_up;
  double warm_up_start_ = 0;
  std::vector<double> warm_up_ms_;  // of the current case
  std::vector<double> fastest_ms_;  // of each warmed-up case
  int frames_per_sample_ = 1;
  int rounds_ = 1;
  std::size_t samples_ = 1, samples_done_ = 0;
  Series series_;
  BenchmarkResult result_;
};

/// Asserts cases, cameras and at least one round. No frame is in flight on return. The last sample
/// of each case showed the last camera.
BenchmarkResult run_benchmark(std::span<const BenchmarkCase> cases, std::span<const Camera> cameras,
                              const BenchmarkOptions& options = {});

}  // namespace tureen
