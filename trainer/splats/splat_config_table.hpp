// The rows of SplatConfig in the table of each kernel's configuration, and the ranges of rows.
#pragma once

#include <iterator>
#include <vector>

#include "trainer/splats/parameter_kinds.hpp"
#include "trainer/splats/splat_config.hpp"

namespace tureen::trainer {

namespace splat_range {
using namespace ranges;
// 10 million Gaussians of degree 3 take about 23 GB by splat_memory().
inline constexpr Range splats{
    1, 1e7, {}, "a scene needs at least one splat", "the training would need gigabytes"};
inline constexpr Range opacity{0.005, 0.99, {}, "other opacities are not blended, or not trained"};
inline constexpr Range degrees{0, max_trained_degree, {}, "only these degrees are trained"};
inline constexpr Range length{0, 1e3, Range::Ends::low_open, "the value is a length"};
inline constexpr Range extent{1, 1e6, {}, "the splats lie outside of the region"};
}  // namespace splat_range

/// The rows of SplatConfig, then `own`.
template <class C>
std::vector<typename C::Field> with_common_fields(std::vector<typename C::Field> own) {
  using namespace splat_range;
  std::vector<typename C::Field> fields = {
      {"steps", &C::steps, whole, "Optimiser steps; each uses one view"},
      {"max_splats", &C::max_splats, splats, "Largest number of splats"},
      {"first_splats", &C::first_splats, splats,
       "Number of random splats, or of samples on a mesh, at the start; if the dataset has fewer "
       "points, random splats are added"},
      {"first_opacity", &C::first_opacity, opacity, "Opacity of the initial splats"},
      {"far_splats", &C::far_splats, fraction,
       "Fraction of the random splats outside of the region of interest; by default 0 if the "
       "images have alpha, else 0.5"},
      {"far_extent", &C::far_extent, extent,
       "Largest distance of these splats from the centre of the region, in its half sides"},
      {"degree", &C::degree, degrees, "Degree of the harmonics of the colours"},
      {"degree_steps", &C::degree_steps, fraction,
       "Fraction of the steps after which the next degree is trained, too"},
      {"densify_every", &C::densify_every, whole,
       "Largest number of steps between densifications; in shorter runs 1/25 of all steps, but at "
       "least 20"},
      {"densify_until", &C::densify_until, fraction,
       "Fraction of the steps after which densification ends"},
      {"growth", &C::growth, fraction,
       "Largest growth of the number of splats at a densification, as a fraction"},
      {"half_size_until", &C::half_size_until, fraction,
       "Fraction of the steps in which images have half their width and height"},
      {"background", &C::background, color,
       "Colour behind all splats: red, green, blue; by default white if the images have alpha, "
       "else black"},
      {"l1_weight", &C::l1_weight, weight, "Weight of the mean absolute error"},
      {"ssim_weight", &C::ssim_weight, weight, "Weight of (1 - SSIM) / 2"},
      {"seed", &C::seed, any_seed, "Random seed; equal seeds give equal splats"},
      {"initialisation", &C::initialisation, none,
       "Source of the initial splats: points of the dataset, random points, or a scene; automatic "
       "uses points of the dataset, or finds some in photographs of a place",
       initialisation_words},
      {"minutes", &C::minutes, minutes,
       "Training time to which the run fits its steps, whatever steps says; 0 for a fixed number "
       "of steps"},
  };
  fields.insert(fields.end(), std::make_move_iterator(own.begin()),
                std::make_move_iterator(own.end()));
  return fields;
}

}  // namespace tureen::trainer
