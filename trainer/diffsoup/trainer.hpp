// A training run: steps, and the schedule between them (DiffSoup, arXiv 2603.27151, section 4 and
// supplement): decay of the rates, the lift from coarse to fine levels, pruning and splitting.
//
// The next step depends only on the configuration, the views and the state. A resumed run therefore
// ends with the same bits as an uninterrupted one.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "trainer/diffsoup/backend.hpp"
#include "trainer/diffsoup/config.hpp"
#include "trainer/diffsoup/state.hpp"
#include "trainer/diffsoup/topology.hpp"

namespace tureen::trainer {

/// Counts from the last resampling.
struct ResampleReport {
  std::size_t unseen = 0;  // faces removed because no training image showed them
  std::size_t pruned = 0;  // faces removed to meet the budget
  std::size_t split = 0;   // splits
};

class Trainer {
 public:
  /// `views`: the backend's views; they must outlive both objects. `state`: new or saved; numbers
  /// that are not finite are replaced (quarantine). `config`: with lengths in the dataset's units
  /// (scaled_to).
  Trainer(const Config& config, std::span<const TrainingView> views,
          std::unique_ptr<Backend> backend, TrainingState state);

  int steps_done() const { return step_; }
  bool done() const { return step_ >= config_.steps; }
  std::size_t faces() const { return faces_; }

  /// Sets the number of steps, at least steps_done(), for the schedule from the next step on.
  void set_steps(int steps) { config_.steps = steps; }

  /// One step, and the schedule's changes after it.
  StepReport step();

  /// The current state, for a checkpoint or the result.
  TrainingState state() const;

  const ResampleReport& last_resample() const { return last_resample_; }
  Backend& backend() { return *backend_; }
  const Config& config() const { return config_; }

 private:
  int lift_step() const;
  int last_resample_step() const;
  bool resamples_now() const;
  void lift();
  void resample();
  std::vector<std::uint64_t> evident_pixels(const Model& model, std::span<const Camera> cameras);
  std::vector<Split> choose_splits(const TrainingState& state, std::span<const Camera> cameras);

  Config config_;
  std::span<const TrainingView> views_;
  std::unique_ptr<Backend> backend_;
  int step_ = 0;
  std::size_t faces_ = 0;
  bool is_lifted_ = false;
  ResampleReport last_resample_;
};

/// The views of step `step` (1, 2, ..): `batch` of `count` views. Every epoch uses each view once,
/// in an order that depends only on seed and epoch. The last batch of an epoch is shorter if
/// `batch` does not divide `count`. A view must not be in a batch twice: the same draws would count
/// twice, and two tasks would write to the same pixels of the baseline.
std::vector<std::uint32_t> batch_of(int step, int batch, std::size_t count, std::uint64_t seed);

}  // namespace tureen::trainer
