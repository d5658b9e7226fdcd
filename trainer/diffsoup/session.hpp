// A training run from its first step to its last: the steps of a Trainer, the log, checkpoints,
// previews and held-out views.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/photographs.hpp"
#include "trainer/common/training_log.hpp"
#include "trainer/diffsoup/checkpoint.hpp"
#include "trainer/diffsoup/trainer.hpp"

namespace tureen::trainer {

/// A moment of the run, for people who wait.
struct SessionStatus {
  int step = 0, steps = 0;             // done, of all
  double loss = 0;                     // smoothed; 0 before the first step
  std::optional<double> test_psnr_db;  // of the held-out views, when last measured
  double seconds_per_step = 0;         // smoothed; 0 before the first step
};

struct SessionOptions {
  std::filesystem::path checkpoint;             // replaced at each
  std::filesystem::path log;                    // JSON lines
  std::filesystem::path previews;               // a folder that exists, where preview_every > 0
  std::optional<int> checkpoint_every;          // steps; by default every two minutes
  int preview_every = 0;                        // steps; 0 draws none
  std::span<const Photograph> test_views = {};  // at least one
  double seconds_before = 0;  // of training, in sessions that this one goes on from
  /// Called before each step; what it throws ends the run.
  std::function<void(const SessionStatus&)> progress = {};
  /// Called after the checkpoint of a run that ends early.
  std::function<void(int step)> interrupted = {};
};

class TrainingSession {
 public:
  /// `run` is what checkpoints say of it; its state and seconds are filled in here. `trainer`,
  /// and what the options point to, must outlive the session.
  TrainingSession(Trainer& trainer, SessionOptions options, Checkpoint run);

  /// Trains to the last step. Throws OutputError where a file cannot be written, and what
  /// SessionOptions::progress throws. Either way a checkpoint is written first, where that can be.
  void run();

  /// Does what is left to do after run(); where it throws the checkpoint is written first.
  void keep_if_it_fails(const std::function<void()>& work);

  /// Of training, sessions before this one included.
  double seconds() const;

 private:
  /// Sums over the steps since the last record.
  struct Recent {
    int steps = 0;
    double loss = 0, l1 = 0, ssim = 0, mse = 0;
    double begin = 0;  // seconds() at the first of them
  };

  void train_to_the_end();
  void after_step(const StepReport& report);
  void measure();
  void record();
  void write_preview();
  void save_checkpoint();
  void keep();
  SessionStatus status() const;

  Trainer& trainer_;
  SessionOptions options_;
  Checkpoint run_;
  std::vector<Photograph> measured_views_;
  TrainingLog log_;
  int test_every_;
  double start_ = 0;            // of the clock
  double last_checkpoint_ = 0;  // seconds()
  Recent recent_;
  bool in_step_ = false;  // the state may be half of one step and half of the next
  std::uint64_t non_finite_ = 0;
  double loss_ = 0;  // smoothed, as shown
  double seconds_per_step_ = 0;
  std::optional<double> fresh_test_psnr_, shown_test_psnr_;
};

}  // namespace tureen::trainer
