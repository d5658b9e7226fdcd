// A training run of triangle windows on posed photographs (Triangle Splatting, arXiv 2505.19175):
// one photograph a step. The next step depends only on the configuration, the views and the state;
// it has the same bits with any number of threads.
//
// With WindowConfig::opaque, the windows become opaque triangles in the last part of the run: sigma
// is limited to an ever lower value, and opacity has an ever higher floor, as in Triangle
// Splatting+ (arXiv 2509.25122, section 3.3). The authors' variant for game engines has two losses
// instead (mean sigma and one over the mean opacity), which fix neither the end nor its time.
//
// Not implemented: the losses of normals and of distortion (weights 1e-4 and 0 for scenes without
// walls).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/photographs.hpp"
#include "scene/triangle_soup.hpp"
#include "trainer/common/cpu/image_loss.hpp"
#include "trainer/common/region.hpp"
#include "trainer/common/training_views.hpp"
#include "trainer/splats/window_densify.hpp"
#include "trainer/splats/window_raster.hpp"

namespace tureen::trainer {

struct WindowConfig {
  int steps = 5000;
  std::size_t max_splats = 60000;
  std::size_t first_splats = 30000;  // at most as many as points, if there are points
  /// Circumradius of the first triangles: at random places relative to the mean spacing, at points
  /// relative to twice the distance to the nearest other point.
  float first_size = 0.4f;
  float first_opacity = 0.28f, first_sigma = 1.16f;  // as Triangle Splatting
  int degree = 2;                                    // of the harmonics, up to max_trained_degree
  /// Steps of each degree of harmonics before the next one is trained, a fraction of all steps.
  double degree_steps = 0.1;
  int densify_every = 100;     // steps
  double densify_until = 0.8;  // fraction of the steps
  WindowSampling sampling = WindowSampling::motion;
  /// Alternate between WindowSampling::opacity and inverse_sigma; `sampling` is not used.
  bool alternate_sampling = false;
  float overlap = 0.1f;    // WindowDensifyOptions
  double rate_factor = 1;  // multiplies the rates of the corners
  float background[3] = {1, 1, 1};
  /// 0.8 L1 + 0.2 (1 - SSIM) as in 3DGS.
  float l1_weight = 0.8f, ssim_weight = 0.4f;
  float opacity_weight = 0.0055f;  // of the mean opacity
  float size_weight = 1e-8f;       // of the mean of 1 / area, in 1 / (layer unit)^2
  double size_until = 0.83;        // fraction of the steps; 25,000 of 30,000
  bool opaque = false;
  double opaque_from = 0.5, opaque_until = 0.9;  // fractions of the steps
  /// From this fraction of the steps on, windows below this opacity are dead. The floor of opacity
  /// soon exceeds it.
  double prune_from = 0.4;
  float min_opacity_before_opaque = 0.2f;
  /// At opaque_until: the largest sigma, and the floor of opacity.
  float last_sigma = 0.03f, last_min_opacity = 0.9999f;
  std::uint64_t seed = 0;
};

struct WindowStepReport {
  double loss = 0, l1 = 0, ssim = 0;  // of the image
  std::size_t quarantined = 0;        // splats and pixels that are not finite
  std::size_t dead = 0, split = 0;    // of a densification after this step
};

class WindowTrainer {
 public:
  /// `views` must outlive the trainer. `threads`: 0 for all cores. Triangles have random
  /// orientations. They are at `points`, with their colours, or grey and random in the region.
  WindowTrainer(const WindowConfig& config, std::span<const TrainingView> views,
                const Region& region, int threads, std::span<const DatasetPoint> points = {});

  bool done() const { return step_ >= config_.steps; }
  int steps_done() const { return step_; }
  WindowStepReport step();

  /// Red, green and blue planes, row 0 on top, not clamped; with harmonics of all degrees.
  std::vector<float> render(const Camera& camera);

  /// Opaque triangles with the same harmonics, of the windows that were evident in a step since the
  /// last densification.
  TriangleSoup to_soup() const;

  const WindowParameters& parameters() const { return parameters_; }
  SplatTimes& times() { return raster_.times(); }

 private:
  int degree_now() const;
  const TrainingView& next_view();
  std::size_t update(const WindowBackwardInput& input);
  /// Limits of sigma and opacity on the way to opaque triangles.
  void anneal();
  WindowDensifyReport densify();

  WindowConfig config_;
  std::span<const TrainingView> views_;
  Region region_;  // its half side is the unit of rates
  ThreadPool pool_;
  WindowRaster raster_;
  WindowParameters parameters_;
  SplatMemory memory_;
  Random random_;
  int step_ = 0, densifications_ = 0;
  std::vector<std::uint32_t> epoch_;  // views that this epoch has yet to use, from the back
  std::vector<float> planes_, gradient_;
  ImageLossScratch<float> loss_scratch_;
};

}  // namespace tureen::trainer
