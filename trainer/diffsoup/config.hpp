// All constants of training. The defaults are Tureen's constants for Preset::object, except near,
// far and max_level; preset() sets those. `preset` and `published` return the other sets; a
// --config file or an option overrides single constants.
//
// Source: DiffSoup (arXiv 2603.27151), its supplement and its code. Comments explain where our
// values differ; docs/benchmarks.md has the gains.
#pragma once

#include <cstdint>
#include <string>

#include "trainer/common/initialisation.hpp"

namespace tureen::trainer {

enum class Preset {
  object,  // images of one object from all directions, usually with alpha
  scene,   // photographs of a place, with or without points from structure from motion
};

/// Precision of texel gradients between the passes of one step.
enum class GradientPrecision { float32, float16 };

/// The unit of training lengths. vertex_rate, near and far are in world units for a region of
/// interest (scene/region.hpp) with this half side; for other regions they are multiplied
/// by half side / reference_extent. The value is close to NeRF-synthetic, the source of the
/// published numbers.
inline constexpr double reference_extent = 1.5;

/// Config::max_level that depends on the dataset (trainer/diffsoup/texture_level.hpp). A Trainer
/// needs a level from 0 on.
inline constexpr int automatic_level = -1;
/// The highest level that it becomes, unless min_level is above: the published one. More would need
/// gigabytes; here a face has 74 kB in training, with Adam's moments.
inline constexpr int highest_automatic_level = 5;

struct Config {
  Preset preset = Preset::object;

  // --- The run
  int steps = 10'000;
  /// Training time to which the run fits `steps`, in minutes; 0: `steps` as given.
  double minutes = 0;
  int batch = 4;  // views a step
  std::uint64_t seed = 0;
  int triangles = 15'000;  // the budget; the final number is exactly this

  // --- Initialisation
  Initialisation initialisation = Initialisation::automatic;
  /// With automatic initialisation, if the dataset has no points: the steps of a training of
  /// Gaussians. The first triangles lie on these (TrainingRequest::first_scene). 0: no
  /// Gaussians. Published: 0.
  int gaussian_steps = 1500;
  int initial_triangles = 15'000;  // published for objects: 100,000
  float initial_radius = 1.0f;     // circumradius as a multiple of the mean distance to the nearest
                                   // neighbour; published: 0.25, for objects 0.28
  bool local_radius = false;  // with points: each radius uses the distance to the triangle's own
                              // nearest neighbour, as always with Gaussians
  float box = 0.0f;  // half side of the box for random points in world units; 0: from the cameras
  float far_points = 0.0f;  // fraction of the random points outside the box
  float far_extent = 8.0f;  // largest distance of these points, in half sides of the box
  /// Largest number of triangles of the backing layer (trainer/diffsoup/backing.hpp). If there is
  /// one, `far` is raised to contain it. Ours for scenes: 80; published: 0.
  int backing_triangles = 0;
  /// With points: this fraction of all triangles starts around the box, where structure from motion
  /// found no points; published: 0.
  float around_points = 0.0f;

  // --- The texture
  int coarse_level = 0;            // of all faces until lift_at
  int min_level = 2;               // then levels min_level .. max_level
  int max_level = 3;               // in our presets: automatic_level; published: 5
  float lift_at = 0.05f;           // published: 0.5; fraction of the steps before finer levels
  bool lift_keeps_opacity = true;  // published: false, opacity restarts at one half

  // --- The loss: l1_weight * mean |C - G| + ssim_weight * (1 - SSIM) / 2
  float l1_weight = 0.8f;
  float ssim_weight = 0.2f;
  float opacity_l1_weight = 1.0f;  // scale of the loss that drives the opacity (score function):
                                   // sum over channels of |C - G|
  bool baseline = true;         // published: false. Subtracts a running mean from the score's loss
  float baseline_rate = 0.25f;  // update rate of that mean, an exponential average per pixel

  /// Factor of one part of the gradient of the corners: when corners move, the texture slides
  /// inside the face. Both pixels of each neighbouring pair add this part, so one half is exact;
  /// published: 1.
  float texture_slide = 0.5f;

  // --- Optimisation
  float texture_rate = 5e-2f;  // features and opacity
  float mlp_rate = 1e-2f;
  float vertex_rate = 1e-2f;  // training length, see above; published for objects: 1e-3
  float decay = 0.01f;        // rates fall to this fraction, exponentially
  float beta1 = 0.9f, beta2 = 0.999f, epsilon = 1e-8f;
  bool dense_updates =
      false;  // published: true. Also steps faces that no image of the batch touched
  bool reset_moments = false;  // published: true. Moments restart at every resampling
  GradientPrecision gradient_precision = GradientPrecision::float32;

  // --- Resampling: pruning and splitting
  int resample_every = 100;
  float resample_until = 0.95f;   // fraction of the steps after which resampling ends
  bool resample_textures = true;  // published: false, children copy the parent's texels
  float turnover = 0.05f;         // published: 0. Fraction of the faces, those with the fewest
                                  // pixels, that is replaced at each resampling
  // Turnover ends after this fraction of the steps. Later, learning rates are below a tenth of
  // their start and new faces hardly converge: held-out views of lego lost 0.3 dB with turnover
  // between one half and three quarters of a run.
  float turnover_until = 0.5f;
  bool split_by_error = true;   // published: false. Splits the faces with the largest error instead
                                // of the longest edges
  float split_fraction = 0.2f;  // of the image's height: longer projected edges are split
  int split_views = 20;         // maximum number of views that choose edges
  /// Published for scenes: true. Splits all edges longer than split_fraction, and the next pruning
  /// restores the budget. If false, splits stop at the budget.
  bool split_beyond_budget = false;
  /// Faces visible in fewer training images are removed. Ours for scenes: 3; published: 1. The
  /// effective minimum is at most 1 + training images / 20.
  int min_views = 1;

  // --- The image
  float near = 0.01f;
  float far = 100.0f;
  /// Published: false. Removes a face if a part of it lies in the image of a training view and
  /// nearer to the camera than the near plane. The runtime's near plane is closer, and would show
  /// these untrained parts.
  bool clear_near = false;
  float background[3] = {1, 1, 1};
};

/// Our choices for a kind of dataset.
Config preset(Preset kind);

/// The published choices wherever they differ from ours (--compat).
Config published(Preset kind);

/// The configuration with its training lengths (vertex_rate, near, far: see reference_extent) in
/// the units of a dataset whose region of interest has this half side.
Config scaled_to(const Config& config, double half_side);

}  // namespace tureen::trainer
