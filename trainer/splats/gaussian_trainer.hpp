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
#include "trainer/splats/gaussian_densify.hpp"
#include "trainer/splats/gaussian_raster.hpp"

namespace tureen::trainer {

struct GaussianConfig {
  int steps = 5000;
  std::size_t max_splats = 60000;
  std::size_t first_splats = 10000;  // random ones
  float first_opacity = 0.3f;
  int degree = 2;  // of the harmonics, up to max_trained_degree
  /// Steps of each degree of harmonics before the next one is trained, a fraction of all steps.
  double degree_steps = 0.1;
  int densify_every = 200;
  double densify_until = 0.8;  // fraction of the steps
  double growth = 0.15;        // of the number of splats at each densification
  /// Images have half their width and height until this fraction of the steps.
  double half_size_until = 0.0;
  float background[3] = {1, 1, 1};
  /// 0.8 L1 + 0.2 (1 - SSIM) as in 3DGS.
  float l1_weight = 0.8f, ssim_weight = 0.4f;
  /// Scales have at least and at most this length, relative to the region's half side.
  float min_scale = 3e-4f, max_scale = 1;
  std::uint64_t seed = 0;
};

struct GaussianStepReport {
  double loss = 0, l1 = 0, ssim = 0;
  std::size_t quarantined = 0;      // splats and pixels that are not finite
  std::size_t dead = 0, split = 0;  // of a densification after this step
};

class GaussianTrainer {
 public:
  /// `views` must outlive the trainer. `threads`: 0 for all cores. Splats are random in the region,
  /// grey, and as large as gives each its share of the volume.
  GaussianTrainer(const GaussianConfig& config, std::span<const TrainingView> views,
                  const Region& region, int threads);

  bool done() const { return step_ >= config_.steps; }
  int steps_done() const { return step_; }
  GaussianStepReport step();

  /// Three planes, row 0 on top, not clamped.
  std::vector<float> render(const Camera& camera);

  const GaussianParameters& parameters() const { return parameters_; }
  SplatTimes& times() { return raster_.times(); }

 private:
  int degree_now() const;
  const TrainingView& next_view();

  GaussianConfig config_;
  std::span<const TrainingView> views_;
  std::vector<TrainingView> half_views_;
  double length_;  // half side of the region
  ThreadPool pool_;
  GaussianRaster raster_;
  GaussianParameters parameters_;
  GaussianMemory memory_;
  Random random_;
  int step_ = 0;
  std::vector<std::uint32_t> epoch_;  // views that this epoch has yet to use, from the back
  std::vector<float> planes_, gradient_;
  ImageLossScratch<float> loss_scratch_;
};

}  // namespace tureen::trainer
