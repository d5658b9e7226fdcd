// A training run of Gaussians on posed photographs: one photograph a step. The next step depends
// only on the configuration, the views and the state; it has the same bits with any number of
// threads.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "trainer/common/cpu/image_loss.hpp"
#include "trainer/common/region.hpp"
#include "trainer/common/training_views.hpp"
#include "trainer/splats/gaussian_config.hpp"
#include "trainer/splats/gaussian_densify.hpp"
#include "trainer/splats/gaussian_raster.hpp"
#include "trainer/splats/gaussian_state.hpp"

namespace tureen::trainer {

/// `first_splats` round, grey Gaussians, uniform in the cube of the region. With the side s of a
/// cube that is each one's share of the volume, their standard deviation is s / 4.
/// The last ones are around the region, as GaussianConfig::far_splats says, and larger in
/// proportion to their distance.
GaussianParameters random_gaussians(const GaussianConfig& config, const Region& region,
                                    Random& random);

struct GaussianStepReport {
  double loss = 0, l1 = 0, ssim = 0;
  std::size_t quarantined = 0;      // splats and pixels that are not finite
  std::size_t dead = 0, split = 0;  // of a densification after this step
};

class GaussianTrainer {
 public:
  /// Begins with random_gaussians(). `views` must outlive the trainer. `threads`: 0 for all cores.
  GaussianTrainer(const GaussianConfig& config, std::span<const TrainingView> views,
                  const Region& region, int threads);
  /// Continues from a state, whose splats have config.degree.
  GaussianTrainer(const GaussianConfig& config, std::span<const TrainingView> views,
                  const Region& region, int threads, GaussianState state);

  bool done() const { return step_ >= config_.steps; }
  int steps_done() const { return step_; }
  GaussianStepReport step();
  /// Sets the number of steps of the run, at least steps_done(), for the schedule from the next
  /// step on.
  void set_steps(int steps) { config_.steps = steps; }
  const GaussianConfig& config() const { return config_; }
  /// A copy, for a checkpoint; GaussianState::non_finite and fits are 0.
  GaussianState state() const;
  /// Mean squared error of the last step's image over its pixels that are not ignored, without
  /// clamping. Needs a step().
  double last_mse() const;

  /// Red, green and blue planes, row 0 on top, not clamped; with harmonics of all degrees.
  std::vector<float> render(const Camera& camera);

  const GaussianParameters& parameters() const { return parameters_; }
  int threads() const { return pool_.threads(); }
  SplatTimes& times() { return raster_.times(); }

 private:
  int degree_now() const;
  const TrainingView& next_view();

  GaussianConfig config_;
  std::span<const TrainingView> views_;
  std::vector<TrainingView> half_views_;
  Region region_;  // its half side is the unit of rates and scales
  ThreadPool pool_;
  GaussianRaster raster_;
  GaussianParameters parameters_;
  SplatMemory memory_;
  Random random_;
  int step_ = 0;
  const TrainingView* last_view_ = nullptr;
  std::vector<std::uint32_t> epoch_;  // views that this epoch has yet to use, from the back
  std::vector<float> planes_, gradient_;
  ImageLossScratch<float> loss_scratch_;
};

}  // namespace tureen::trainer
