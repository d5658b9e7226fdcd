// A training run: steps, and between them the schedule that turns a cloud of triangles into a soup
// (DiffSoup, arXiv 2603.27151, section 4 and supplement): rates that decay, the lift from coarse to
// fine levels, pruning and splitting.
//
// What a run does next is a function of its configuration, its views and its state alone: a run
// that goes on from a saved state ends with the same bits as one that never stopped.
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

/// What the last resampling did.
struct ResampleReport {
  std::size_t unseen = 0;  // removed: no training image showed them
  std::size_t pruned = 0;  // removed for the budget
  std::size_t split = 0;   // splits
};

class Trainer {
 public:
  /// `views` are the backend's too, and must outlive both. The state is new or a saved one, and
  /// what in it is no number is put aside (quarantine); the configuration's lengths are in the
  /// dataset's units by now (scaled_to).
  Trainer(const Config& config, std::span<const TrainingView> views,
          std::unique_ptr<Backend> backend, TrainingState state);

  int steps_done() const { return step_; }
  bool done() const { return step_ >= config_.steps; }
  std::size_t faces() const { return faces_; }

  /// One step, and what the schedule has after it.
  StepReport step();

  /// The state as it is now, for a checkpoint or the result.
  TrainingState state() const;

  const ResampleReport& last_resample() const { return last_resample_; }
  Backend& backend() { return *backend_; }
  const Config& config() const { return config_; }

 private:
  int last_resample_step() const;
  void lift();
  void resample();
  std::vector<std::uint64_t> evident_pixels(const Model& model, std::span<const Camera> cameras);
  std::vector<Split> choose_splits(const TrainingState& state, std::span<const Camera> cameras);

  Config config_;
  std::span<const TrainingView> views_;
  std::unique_ptr<Backend> backend_;
  int step_ = 0;
  std::size_t faces_ = 0;
  ResampleReport last_resample_;
};

/// The views of step `step` (1, 2, ..): `batch` of `count`, so that every epoch shows each view
/// once, in an order that only seed and epoch decide. The last batch of an epoch is shorter where
/// `batch` does not divide `count`: no view is in a batch twice, as the same draws would count
/// double and two tasks would write to the same pixels of the baseline.
std::vector<std::uint32_t> batch_of(int step, int batch, std::size_t count, std::uint64_t seed);

}  // namespace tureen::trainer
