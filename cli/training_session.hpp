// A training run as somebody sees it: progress, the log, checkpoints and previews around the steps
// of a Trainer.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cli/training_files.hpp"
#include "cli/training_log.hpp"
#include "formats/dataset/dataset.hpp"
#include "trainer/diffsoup/checkpoint.hpp"
#include "trainer/diffsoup/trainer.hpp"

namespace tureen::cli {

struct SessionOptions {
  TrainingFiles files;
  std::optional<int> checkpoint_every;     // steps; by default every two minutes
  int preview_every = 0;                   // steps; 0 draws none
  std::span<const Photograph> test_views;  // one at least
  double seconds_before = 0;               // of training, in sessions that this one goes on from
};

class TrainingSession {
 public:
  /// `run` is what checkpoints say of it; its state and seconds are filled in here. `trainer`,
  /// and what the options point to, must outlive the session.
  TrainingSession(trainer::Trainer& trainer, SessionOptions options, trainer::Checkpoint run);

  /// Trains to the last step. Throws OutputError where a file cannot be written, and Interrupted
  /// after Ctrl-C. Either way a checkpoint is written, where that can be, and it is said how to go
  /// on.
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
  void after_step(const trainer::StepReport& report);
  void measure();
  void record();
  void write_preview();
  void save_checkpoint();
  void keep();
  std::string detail() const;

  trainer::Trainer& trainer_;
  SessionOptions options_;
  trainer::Checkpoint run_;
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

/// "7 s", "3 min 20 s", "2 h 5 min".
std::string duration_text(double seconds);

}  // namespace tureen::cli
