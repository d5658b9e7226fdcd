#include "trainer/splats/gaussian_config.hpp"

#include "base/existing_path.hpp"
#include "base/json/json_file.hpp"
#include "trainer/splats/gaussian_parameters.hpp"

namespace tureen::trainer {

namespace gaussian_table {
namespace {

constexpr Range whole{1, 1e7, {}, "a run needs at least one step", "the run would take weeks"};
// 10 million Gaussians of degree 3 take about 23 GB by gaussian_memory().
constexpr Range splats{
    1, 1e7, {}, "a scene needs at least one splat", "the training would need gigabytes"};
constexpr Range fraction{0, 1, {}, "the value is a fraction"};
constexpr Range opacity{0.005, 0.99, {}, "other opacities are not blended, or not trained"};
constexpr Range degrees{0, max_trained_degree, {}, "only these degrees are trained"};
constexpr Range weight{0, 1000, {}, "a negative weight would increase the error"};
constexpr Range length{0, 1e3, Range::Ends::low_open, "the value is a length"};
constexpr Range extent{1, 1e6, {}, "the splats lie outside of the region"};
constexpr Range any_seed{
    0, 18446744073709551616.0, {}, "the seed is an unsigned number of 64 bits"};
constexpr Range minutes{0,
                        1e5,
                        {},
                        "the value is a time, or 0 for a fixed number of steps",
                        "the run would take months"};
constexpr Range none{};

const GaussianConfigField fields[] = {
    {"steps", &GaussianConfig::steps, whole, {}, "Optimiser steps; each uses one view"},
    {"max_splats", &GaussianConfig::max_splats, splats, {}, "Largest number of splats"},
    {"first_splats",
     &GaussianConfig::first_splats,
     splats,
     {},
     "Number of random splats, or of samples on a mesh, at the start; if the dataset has fewer "
     "points, random splats are added"},
    {"first_opacity", &GaussianConfig::first_opacity, opacity, {}, "Opacity of the first splats"},
    {"far_splats",
     &GaussianConfig::far_splats,
     fraction,
     {},
     "Fraction of the random splats outside of the region of interest; by default 0 if the images "
     "have alpha, else 0.5"},
    {"far_extent",
     &GaussianConfig::far_extent,
     extent,
     {},
     "Largest distance of these splats from the centre of the region, in its half sides"},
    {"degree", &GaussianConfig::degree, degrees, {}, "Degree of the harmonics of the colours"},
    {"degree_steps",
     &GaussianConfig::degree_steps,
     fraction,
     {},
     "Fraction of the steps after which the next degree is trained, too"},
    {"densify_every",
     &GaussianConfig::densify_every,
     whole,
     {},
     "Largest number of steps between densifications; in shorter runs 1/25 of all steps, but at "
     "least 20"},
    {"densify_until",
     &GaussianConfig::densify_until,
     fraction,
     {},
     "Fraction of the steps after which densification ends"},
    {"growth",
     &GaussianConfig::growth,
     fraction,
     {},
     "Largest growth of the number of splats at a densification, as a fraction"},
    {"half_size_until",
     &GaussianConfig::half_size_until,
     fraction,
     {},
     "Fraction of the steps in which images have half their width and height"},
    {"background",
     &GaussianConfig::background,
     {0, 1, {}, "the value is a display-referred colour"},
     {},
     "Colour behind all splats: red, green, blue; by default white if the images have alpha, else "
     "black"},
    {"l1_weight", &GaussianConfig::l1_weight, weight, {}, "Weight of the mean absolute error"},
    {"ssim_weight", &GaussianConfig::ssim_weight, weight, {}, "Weight of (1 - SSIM) / 2"},
    {"min_scale",
     &GaussianConfig::min_scale,
     length,
     {},
     "Smallest standard deviation of a splat, relative to the half side of the region of interest"},
    {"max_scale",
     &GaussianConfig::max_scale,
     length,
     {},
     "Largest standard deviation of a splat, in the same unit"},
    {"seed", &GaussianConfig::seed, any_seed, {}, "Random seed; equal seeds give equal splats"},
    {"initialisation", &GaussianConfig::initialisation, none, initialisation_words,
     "Source of the first splats: points of the dataset, random points, or a scene; automatic uses "
     "points if the dataset has any"},
    {"minutes",
     &GaussianConfig::minutes,
     minutes,
     {},
     "Training time to which the run fits its steps, whatever steps says; 0 for a fixed number of "
     "steps"},
};

}  // namespace
}  // namespace gaussian_table

std::span<const GaussianConfigField> gaussian_config_fields() { return gaussian_table::fields; }

std::optional<std::string> defect(const GaussianConfig& config) {
  if (auto found = range_defect(config, gaussian_config_fields())) return found;
  if (!(config.min_scale < config.max_scale))
    return "min_scale: " + float_text(config.min_scale) + " is not below max_scale, " +
           float_text(config.max_scale);
  if (config.l1_weight == 0 && config.ssim_weight == 0)
    return "l1_weight: 0, and ssim_weight is 0 too (one of them must be above 0)";
  return std::nullopt;
}

GaussianConfig read_gaussian_config(Input& input, const GaussianConfig& defaults) {
  const nlohmann::json document = read_json(input, RepeatedKeys::refused);
  const JsonView root(document, input.name());
  GaussianConfig config = defaults;
  assign_fields(config, gaussian_config_fields(), root);
  if (const std::optional<std::string> reason = defect(config)) root.fail(*reason);
  return config;
}

GaussianConfig read_gaussian_config(const std::filesystem::path& path,
                                    const GaussianConfig& defaults) {
  require_there(path);
  Input input = Input::open(path);
  return read_gaussian_config(input, defaults);
}

std::string config_to_json(const GaussianConfig& config) {
  return fields_to_json(config, gaussian_config_fields());
}

std::optional<std::string> difference(const GaussianConfig& now, const GaussianConfig& checkpoint) {
  GaussianConfig fitted = now;
  if (checkpoint.minutes > 0) fitted.steps = checkpoint.steps;
  return first_difference(fitted, checkpoint, gaussian_config_fields());
}

std::string gaussian_config_reference() {
  const GaussianConfig config;
  std::string text;
  for (const GaussianConfigField& field : gaussian_config_fields())
    text += field_reference(config, field, value_text(config, field));
  return text;
}

}  // namespace tureen::trainer
