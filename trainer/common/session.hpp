// A training run from its first step to its last: the steps of a Trainable, the log, checkpoints,
// previews and held-out views.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/photographs.hpp"
#include "trainer/common/run_control.hpp"
#include "trainer/common/session_timers.hpp"
#include "trainer/common/trainable.hpp"
#include "trainer/common/training_log.hpp"

namespace tureen::trainer {

/// Progress of a run, for display.
struct SessionStatus {
  int step = 0, steps = 0;             // completed steps, total steps
  double loss = 0;                     // smoothed; 0 before the first step
  std::optional<double> test_psnr_db;  // last measurement on held-out views
  std::size_t measured_views = 0;      // their number
  double seconds_per_step = 0;         // smoothed; 0 before the first step
  double seconds_left = 0;             // a forecast; 0 before the first step
  double fraction = 0;                 // of the time, if the run has one, otherwise of the steps
  bool fits_steps = false;             // `steps` may change
  bool paused = false;                 // by SessionOptions::control
};

/// "paused, 120/500, loss 0.0812, 23.41 dB of 5 views, 14.2 it/s, 27 s left".
std::string describe(const SessionStatus& now);

struct SessionOptions {
  std::filesystem::path checkpoint;             // replaced by each checkpoint
  std::filesystem::path log;                    // JSON lines
  std::filesystem::path previews;               // an existing folder, if preview_every > 0
  std::optional<int> checkpoint_every;          // steps; by default every two minutes
  int preview_every = 0;                        // steps; 0 for no previews
  std::span<const Photograph> test_views = {};  // if none, no error is measured
  Camera preview_camera = {};                   // of the previews without test views
  double seconds_before = 0;                    // training time of earlier sessions of this run
  double seconds = 0;  // more than 0: the steps are fitted to this training time (TimeFit)
  std::function<double()> clock = {};   // seconds; by default a steady clock
  std::uint64_t non_finite_before = 0;  // numbers quarantined in earlier sessions
  RunControl* control = nullptr;        // pauses the run, and finishes it early
  /// Returns a JSON object about the run, for the first line of a new log; may be empty.
  std::function<std::string()> plan = {};
  /// Called before the first step, and then by SnapshotTimer.
  std::function<void()> snapshot = {};
  /// Called before each step and during a pause; an exception ends the run.
  std::function<void(const SessionStatus&)> progress = {};
  /// Called after the checkpoint of a run that ends early.
  std::function<void(const SessionStatus&)> interrupted = {};
};

class TrainingSession {
 public:
  /// `run` and the spans in `options` must outlive the session.
  TrainingSession(Trainable& run, SessionOptions options);

  /// Trains to the last step, or until `control` finishes it. Throws OutputError if a file
  /// cannot be written, and the exceptions of SessionOptions::progress. In both cases it first
  /// writes a checkpoint if possible.
  void run();

  /// Runs `work` after run(). If it throws, writes a checkpoint and then passes the error on.
  void keep_if_it_fails(const std::function<void()>& work);

  /// Training time, including earlier sessions, without pauses.
  double seconds() const;

 private:
  /// Sums over the steps since the last record.
  struct Recent {
    int steps = 0;
    double loss = 0, l1 = 0, ssim = 0, mse = 0;
    double begin = 0;  // seconds() before the first of them
  };

  /// Sums over the last steps with weights that fall by 2 % per step.
  struct Pace {
    double steps = 0, work = 0, seconds = 0;
  };

  void train_to_the_end();
  void wait_while_paused();
  void make_snapshot();
  bool done() const { return run_.steps_done() >= run_.steps(); }
  bool at_the_end() const { return done() || finishes_; }
  void after_step(const StepReport& report);
  void measure();
  void record();
  void write_preview();
  void save_checkpoint();
  void keep();
  double seconds_left() const;
  SessionStatus status(bool paused = false) const;

  Trainable& run_;
  SessionOptions options_;
  std::vector<Photograph> measured_views_;
  TrainingLog log_;
  std::function<double()> clock_;
  double start_ = 0;            // of the clock
  double last_checkpoint_ = 0;  // seconds()
  Recent recent_;
  SnapshotTimer snapshots_;
  bool finishes_ = false;  // early
  bool in_step_ = false;   // the state may be between two steps: no checkpoint then
  std::uint64_t non_finite_ = 0;
  double loss_ = 0;     // smoothed, as shown
  int steps_here_ = 0;  // in this session
  Pace pace_;
  TimeFit fit_;
  std::optional<double> fresh_test_psnr_, shown_test_psnr_;
};

}  // namespace tureen::trainer
