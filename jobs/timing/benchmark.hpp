// How frames are timed: the one protocol behind every figure of ours.
//
// Cases take turns frame by frame (A B C A B C ..), so that whatever else the machine does hits
// them alike. Each is warmed up until it is stable. First of all the first case runs against
// itself: the A/A spread is the difference that means nothing. A sample begins with an idle device
// and ends when the device has finished; on fast devices it is several frames of one view, so that
// waiting is not what is measured. The clock is the steady one of the processor.
//
// What it does not do: GL. Cases are functions, so that a test can drive it with a clock of its
// own, and a compute path or another renderer can enter.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "jobs/timing/frame_statistics.hpp"
#include "scene/camera.hpp"

namespace tureen {

/// What takes part. Its functions must draw what they always draw: no error queries, no reading
/// back, no presentation belong in them.
struct BenchmarkCase {
  std::string name;
  std::function<void(const Camera&)> draw;  // may return before the device has finished
  std::function<void()> finish;             // waits for the device
};

struct BenchmarkOptions {
  /// How often the cameras are gone through. At least 1.
  int rounds = 5;
  /// No round is begun that would end later than this, counted from the start and warm-up included;
  /// one round is always made. 0: no limit.
  double max_seconds = 0;

  /// A sample lasts at least this long: the fastest case's frames are repeated within it, up to
  /// `max_frames_per_sample`, and those of the other cases as often. 0: a sample is a
  /// frame.
  double min_sample_ms = 0;
  int max_frames_per_sample = 100;

  /// Warm-up: frames of the first camera, until the last three times lie within `stable_within` of
  /// the smallest of them, but at least and at most this many; none is begun after
  /// `max_warm_up_seconds` but for the least.
  int min_warm_up_frames = 3;
  int max_warm_up_frames = 100;
  double max_warm_up_seconds = 2;
  /// Goes on for so long even when it is stable: graphics cards raise their clocks under load.
  double min_warm_up_seconds = 0;
  /// 5 %: far above the jitter of an idle machine, far below what compiling shaders costs.
  double stable_within = 0.05;

  /// Whether the first case is measured against itself first. Without it aa_spread is 0.
  enum class SelfTest { run, leave_out };
  SelfTest self_test = SelfTest::run;

  /// Called after every sample with the fraction done; may throw to abandon.
  std::function<void(double)> progress = nullptr;
  /// Seconds of a clock that never goes back; the steady clock when empty.
  std::function<double()> clock = nullptr;
};

struct CaseResult {
  std::string name;
  FrameTimes times;  // milliseconds a frame; a sample's mean where it is several frames
  int warm_up_frames = 0;
  bool stable = false;  // whether the warm-up came to rest
};

struct BenchmarkResult {
  std::vector<CaseResult> cases;      // in the order given
  double aa_spread = 0;               // series_spread of the first case against itself
  std::vector<FrameTimes> self_test;  // the two series that it comes from; empty without it
  int rounds = 0;                     // those that were made: as asked, or fewer for time
  int frames_per_sample = 1;
  double seconds = 0;  // all of it
};

/// A clock for BenchmarkOptions: seconds of processor time that all threads of this program have
/// used. Where the processor draws, other programs hardly disturb it, and ratios can be measured on
/// a busy machine; threads that wait cost nothing, so it is not how long a frame takes. Says
/// nothing of a GPU, and is the time of the wall on Windows.
double processor_seconds();

/// The protocol sample by sample, for who has to look after other things in between: a page hands
/// back its thread, or it would be taken for dead.
class BenchmarkRun {
 public:
  /// Asserts that there are cases, cameras and at least one round. All are kept.
  BenchmarkRun(std::span<const BenchmarkCase> cases, std::span<const Camera> cameras,
               const BenchmarkOptions& options = {});

  /// The next part: a warm-up, a sample or what comes between. False when there is none left.
  bool step();
  /// Of the samples, 0..1; 0 during warm-up.
  double fraction() const;
  /// Once step() has said false.
  BenchmarkResult result() &&;

 private:
  enum class Phase { warm_up, self_test, measurement, done };
  /// Rounds of some cases taking turns, until all are made or their share of the time is used
  /// up.
  struct Series {
    std::vector<std::size_t> cases;
    std::vector<FrameTimes> times;  // one a case
    double begin = 0, limit = 0;    // seconds since the start; 0: no limit
    int round = 0;
    std::size_t turn = 0;  // within the round
  };

  double elapsed() const;
  double sample(const BenchmarkCase& benchmark_case, const Camera& camera,
                int frames) const;  // ms a frame
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
  std::vector<double> warm_up_ms_;  // of the case that is warmed up
  std::vector<double> fastest_ms_;  // of each one that was
  int frames_per_sample_ = 1;
  int rounds_ = 1;
  std::size_t samples_ = 1, samples_done_ = 0;
  Series series_;
  BenchmarkResult result_;
};

/// Asserts that there are cases, cameras and at least one round. Leaves no frame in flight. The
/// last sample of each case showed the last camera.
BenchmarkResult run_benchmark(std::span<const BenchmarkCase> cases, std::span<const Camera> cameras,
                              const BenchmarkOptions& options = {});

}  // namespace tureen
