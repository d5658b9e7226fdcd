#include "trainer/diffsoup/config_fields.hpp"

#include <algorithm>
#include <limits>

#include "base/decimal.hpp"
#include "scene/lattice.hpp"

namespace tureen::trainer {

namespace {

using namespace ranges;

constexpr const char* presets[] = {"object", "scene"};
constexpr const char* precisions[] = {"float32", "float16"};

constexpr Range views{
    1, 1024, {}, "a step needs at least one view", "a step keeps all its images in memory"};
// 4 million faces at level 3 have 1.4 GB of texels, with one byte per channel.
constexpr Range faces{
    1, 4e6, {}, "a soup needs at least one triangle", "the textures would need gigabytes"};
constexpr Range levels{0, lattice::max_level, {}, "a lattice has only these levels"};
constexpr Range finest{automatic_level, lattice::max_level, {}, "-1 chooses from 3 to 5"};
constexpr Range share{0, 1, Range::Ends::high_open, "new triangles are cut from remaining ones"};
constexpr Range part{0, 1, Range::Ends::low_open, "the value is a fraction; 0 stops all updates"};
constexpr Range rate{0, 1e6, {}, "a negative rate would increase the loss; 0 changes nothing"};
constexpr Range memory{0, 1, Range::Ends::high_open, "at 1 the mean would never change"};
constexpr Range length{0, 1e9, Range::Ends::low_open,
                       "the value is a distance in front of the camera"};

const ConfigField fields[] = {
    {"preset", &Config::preset, none, "Kind of dataset; sets the defaults of all other fields",
     presets},
    {"steps", &Config::steps, whole, "Optimiser steps"},
    {"minutes", &Config::minutes, minutes,
     "Training time to which the run fits its steps, whatever steps says; 0 for a fixed number of "
     "steps"},
    {"batch", &Config::batch, views, "Views per step"},
    {"seed", &Config::seed, any_seed, "Random seed; equal seeds give equal soups"},
    {"triangles", &Config::triangles, faces, "Exact number of triangles at the end"},
    {"initialisation", &Config::initialisation, none,
     "Source of the initial triangles: points of the dataset, random points, or a scene; automatic "
     "uses points if the dataset has any, else Gaussians",
     initialisation_words},
    {"gaussian_steps",
     &Config::gaussian_steps,
     {0, 1e6, {}, "it is a part of the run"},
     "Without points: steps of the Gaussians that give the initial triangles places and normals; "
     "0: "
     "random points instead"},
    {"initial_triangles", &Config::initial_triangles, faces,
     "Number of triangles at the first step"},
    {"initial_radius",
     &Config::initial_radius,
     {0, 100, Range::Ends::low_open, "a triangle needs a size"},
     "Circumradius of the initial triangles, in mean distances to the nearest neighbour"},
    {"local_radius", &Config::local_radius, none,
     "With points: each triangle uses the distance to its own neighbour instead of the mean"},
    {"box",
     &Config::box,
     {0, 1e9, {}, "the value is a length"},
     "Half side of the box for random points, in world units; 0 derives it from the cameras"},
    {"far_points", &Config::far_points, fraction, "Fraction of the random points outside the box"},
    {"far_extent",
     &Config::far_extent,
     {1, 1e6, {}, "the points lie outside the box"},
     "Largest distance of these points from the centre, in half sides of the box"},
    {"backing_triangles",
     &Config::backing_triangles,
     {0, 1e5, {}, "it is a coarse layer"},
     "Largest number of triangles in a sphere around the scene, behind all others: 20, 80, 320 and "
     "so on, at most a hundredth of the triangles; 0: no sphere"},
    {"around_points", &Config::around_points, fraction,
     "With points: fraction of the triangles placed around the box, where structure from motion "
     "found no points"},
    {"coarse_level", &Config::coarse_level, levels, "Lattice level before lift_at"},
    {"min_level", &Config::min_level, levels, "Coarsest lattice level after lift_at"},
    {"max_level", &Config::max_level, finest,
     "Finest lattice level after lift_at, and level of the written soup; -1 chooses 3 to 5 by the "
     "pixels that a triangle covers"},
    {"lift_at", &Config::lift_at, fraction, "Fraction of the steps before the levels change"},
    {"lift_keeps_opacity", &Config::lift_keeps_opacity, none,
     "Keep the opacity when the levels change; otherwise it restarts at one half"},
    {"l1_weight", &Config::l1_weight, weight, "Weight of the mean absolute difference in the loss"},
    {"ssim_weight", &Config::ssim_weight, weight, "Weight of (1 - SSIM) / 2 in the loss"},
    {"opacity_l1_weight", &Config::opacity_l1_weight, weight,
     "Weight of the absolute difference in the opacity's score"},
    {"baseline", &Config::baseline, none,
     "Subtract a running mean from the score's loss: less variance, the same expectation"},
    {"baseline_rate", &Config::baseline_rate, part, "Update rate of that running mean"},
    {"texture_slide", &Config::texture_slide, weight,
     "Factor of the corner motion caused by a texture inside a triangle; one half is the exact "
     "derivative"},
    {"texture_rate", &Config::texture_rate, rate, "Learning rate of features and opacity"},
    {"mlp_rate", &Config::mlp_rate, rate, "Learning rate of the color MLP"},
    {"vertex_rate", &Config::vertex_rate, rate,
     "Learning rate of positions, for a scene of half side 1.5"},
    {"decay", &Config::decay, part,
     "Factor on all learning rates at the last step; the decay is exponential"},
    {"beta1", &Config::beta1, memory, "Adam's decay rate for the mean gradient"},
    {"beta2", &Config::beta2, memory, "Adam's decay rate for the mean squared gradient"},
    {"epsilon",
     &Config::epsilon,
     {0, 1, Range::Ends::low_open, "it prevents a division by zero"},
     "Constant added to Adam's denominator"},
    {"dense_updates", &Config::dense_updates, none,
     "Adam also steps values that no image of the batch touched"},
    {"reset_moments", &Config::reset_moments, none, "Moments restart at every resampling"},
    {"gradient_precision", &Config::gradient_precision, none,
     "Precision of texel gradients within a step", precisions},
    {"resample_every", &Config::resample_every, whole, "Steps between prunings and splittings"},
    {"resample_until", &Config::resample_until, fraction,
     "Fraction of the steps after which resampling ends"},
    {"resample_textures", &Config::resample_textures, none,
     "Children of a split resample their parent's texture instead of copying it"},
    {"turnover", &Config::turnover, share,
     "Fraction of the triangles, those with the fewest pixels, replaced at each resampling"},
    {"turnover_until", &Config::turnover_until, fraction,
     "Fraction of the steps after which turnover ends"},
    {"split_by_error", &Config::split_by_error, none,
     "Split the triangles with the largest error instead of the longest edges"},
    {"split_fraction",
     &Config::split_fraction,
     {0, 100, Range::Ends::low_open, "at 0 every edge would be split again and again"},
     "Projected edges longer than this fraction of the image height are split"},
    {"split_views", &Config::split_views, whole, "Maximum number of views that choose the edges"},
    {"split_beyond_budget", &Config::split_beyond_budget, none,
     "Split projected edges beyond the number of triangles; the next pruning restores that number"},
    {"least_views", &Config::min_views, whole,
     "Remove triangles visible in fewer training images at each resampling; at most 1 + images / "
     "20"},
    {"near", &Config::near, length, "Near plane, for a scene of half side 1.5"},
    {"far", &Config::far, length, "Far plane, for a scene of half side 1.5"},
    {"clear_near", &Config::clear_near, none,
     "Remove triangles between a training camera and its near plane at each resampling"},
    {"background", &Config::background, color,
     "Colour of pixels without a triangle: red, green, blue"},
};

}  // namespace

std::span<const ConfigField> config_fields() { return fields; }

std::span<const char* const> preset_words() { return presets; }

std::optional<std::string> defect(const Config& config) {
  if (auto found = range_defect(config, config_fields())) return found;
  const auto level = [](int value) { return std::to_string(value); };
  const bool is_automatic = config.max_level == automatic_level;
  if (!is_automatic && config.min_level > config.max_level)
    return "min_level: " + level(config.min_level) + " is above max_level, " +
           level(config.max_level);
  if (config.coarse_level > config.min_level)
    return "coarse_level: " + level(config.coarse_level) + " is above min_level, " +
           level(config.min_level) + " (the lift would lose the learned texture)";
  // Texels of a soup are numbered by 32 bits (LatticePatch::first_texel).
  const int highest =
      is_automatic ? std::max(highest_automatic_level, config.min_level) : config.max_level;
  const std::uint64_t texels = lattice::texel_count(highest);
  if (const auto most = std::numeric_limits<std::uint32_t>::max() / texels;
      std::uint64_t(config.triangles) > most)
    return "triangles: " + std::to_string(config.triangles) + " at level " + level(highest) +
           " have more texels than a soup supports; the limit is " + std::to_string(most) +
           " at that level";
  if (!(config.near < config.far))
    return "near: " + float_text(config.near) + " is not below far, " + float_text(config.far);
  if (config.l1_weight == 0 && config.ssim_weight == 0)
    return "l1_weight: 0, and ssim_weight is 0 too (one of them must be above 0)";
  return std::nullopt;
}

std::string config_reference() {
  const Config object = preset(Preset::object), scene = preset(Preset::scene);
  const Config published_object = published(Preset::object);
  const Config published_scene = published(Preset::scene);
  std::string text;
  for (const ConfigField& field : fields) {
    const std::string value = value_text(object, field), of_scene = value_text(scene, field);
    const std::string a = value_text(published_object, field),
                      b = value_text(published_scene, field);
    std::string defaults = value;
    if (of_scene != value) defaults += "; --preset scene: " + of_scene;
    if (a != value || b != of_scene)
      defaults += "; --compat: " + (a == b ? a : "object " + a + ", scene " + b);
    text += field_reference(object, field, defaults);
  }
  return text;
}

}  // namespace tureen::trainer
