// Every constant of training in one place. Defaults are ours, for an object; `preset` and
// `published` give the other sets, a --config file or an option overrides single ones.
//
// Source: DiffSoup (arXiv 2603.27151), its supplement and its code; where ours differ the comment
// says why, and docs/benchmarks.md has what it gains.
#pragma once

#include <cstdint>
#include <string>

namespace tureen::trainer {

enum class Preset {
  object,  // images of one thing, usually with alpha, from all around
  scene,   // photographs of a place, with points of structure from motion or without
};

enum class Initialisation {
  automatic,  // points where the dataset has some, else random
  points,     // equilateral triangles at points: 2/3 farthest-point, 1/3 uniform samples
  random,     // equilateral triangles at random points of a box
  mesh,       // the triangles of a scene that our readers read
};

/// How gradients of texels are kept between the passes of one step.
enum class GradientPrecision { float32, float16 };

/// Lengths of training: vertex_rate, near and far are in world units where the half side of the
/// region of interest (trainer/diffsoup/initialise.hpp) is this, as it is about in NeRF-synthetic,
/// where the published numbers come from; elsewhere they are multiplied by half side /
/// reference_extent.
inline constexpr double reference_extent = 1.5;

struct Config {
  Preset preset = Preset::object;

  // --- The run
  int steps = 10'000;
  int batch = 4;  // views a step
  std::uint64_t seed = 0;
  int triangles = 15'000;  // the budget, met exactly at the end

  // --- Initialisation
  Initialisation initialisation = Initialisation::automatic;
  int initial_triangles = 15'000;  // published, random: 100,000
  float initial_radius = 1.0f;     // circumradius in mean distances to the nearest neighbour;
                                   // published: 0.25
  bool local_radius = false;  // of points: each by its own neighbour instead of the mean distance
  float box = 0.0f;  // half side of the box for random points in world units; 0: from the cameras
  float far_points = 0.0f;  // the fraction of random points that lies around the box, out to
  float far_extent = 8.0f;  // so many of its half sides
  /// At points: so many of all lie around the box all the same, for what structure from motion
  /// did not find; published: 0.
  float around_points = 0.0f;

  // --- The texture
  int coarse_level = 0;   // the one level until lift_step
  int min_level = 2;      // levels min_level .. max_level afterwards
  int max_level = 3;      // published: 5, which is for images of 800 pixels and more
  float lift_at = 0.05f;  // published: 0.5; fraction of the steps after which the levels are lifted
  bool lift_keeps_opacity = true;  // published: false, opacity starts again at one half

  // --- The loss: l1_weight * mean |C - G| + ssim_weight * (1 - SSIM) / 2
  float l1_weight = 0.8f;
  float ssim_weight = 0.2f;
  float opacity_l1_weight = 1.0f;  // scale of the score's loss, sum over channels of |C - G|
  bool baseline = true;         // published: false. Subtracts a running mean from the score's loss
  float baseline_rate = 0.25f;  // of its exponential moving average, by pixel

  /// Both pixels of a pair slide the texture of the one face that they show, so each counts for one
  /// half of the derivative; published: 1, each in full.
  float texture_slide = 0.5f;

  // --- Optimisation
  float texture_rate = 5e-2f;  // features and opacity
  float mlp_rate = 1e-2f;
  float vertex_rate = 1e-2f;  // lengths of training, see above; published for objects: 1e-3
  float decay = 0.01f;        // rates fall to this fraction, exponentially
  float beta1 = 0.9f, beta2 = 0.999f, epsilon = 1e-8f;
  bool dense_updates = false;  // published: true. Also step what no image of the batch touched
  bool reset_moments = false;  // published: true. Moments start again at every resampling
  GradientPrecision gradient_precision = GradientPrecision::float32;

  // --- Resampling: pruning and splitting
  int resample_every = 100;
  float resample_until = 0.95f;   // fraction of the steps, after which faces stay
  bool resample_textures = true;  // published: false. Children copy the parent's texels
  float turnover = 0.05f;  // published: 0. Fraction of the faces, those of fewest pixels, that
                           // makes room for others at each resampling
  // Fraction of the steps. From there on rates are below a tenth, and what is renewed hardly
  // catches up: held-out views of lego lost 0.3 dB between a half and three quarters of a run.
  float turnover_until = 0.5f;
  bool split_by_error = true;   // published: false. Splits what errs most, not what is longest
  float split_fraction = 0.2f;  // of the image's height: longer projected edges are split
  int split_views = 20;         // at most so many views choose edges
  /// Published for scenes: true. Edges longer than split_fraction are all split, and the next
  /// pruning brings the faces back to the budget, whereas otherwise only pruning makes room.
  bool split_beyond_budget = false;
  /// Published: 1. Faces that fewer training images show are removed; no more are asked for than
  /// one and a twentieth of all.
  int min_views = 1;

  // --- The image
  float near = 0.01f;
  float far = 100.0f;
  /// Published: false. Faces of which a part is in a training image and before its near plane
  /// are removed, so that the runtime, whose near plane is closer, shows what was trained.
  bool clear_near = false;
  float background[3] = {1, 1, 1};
};

/// Our choices for a kind of dataset.
Config preset(Preset kind);

/// The published choices wherever they differ from ours (--compat).
Config published(Preset kind);

/// The configuration with its lengths of training (vertex_rate, near, far: see reference_extent) in
/// the units of a dataset whose region of interest has this half side.
Config scaled_to(const Config& config, double half_side);

}  // namespace tureen::trainer
