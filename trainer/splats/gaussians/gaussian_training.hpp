// Gaussians and discs as methods of SplatTrainer: 3D Gaussian Splatting (arXiv 2308.04079), and 2D
// Gaussian Splatting (arXiv 2403.17888).
//
// Not implemented: the losses of normals and of distance distortion of 2D Gaussian Splatting, which
// are for the extraction of surfaces.
#pragma once

#include <span>

#include "scene/scene.hpp"
#include "trainer/splats/discs/disc_step_kernels.hpp"
#include "trainer/splats/gaussians/gaussian_densify.hpp"
#include "trainer/splats/gaussians/gaussian_step_kernels.hpp"
#include "trainer/splats/splat_trainer.hpp"

namespace tureen::trainer {

struct GaussianTraining {
  using Config = GaussianConfig;
  using Kernel = splatting::GaussianKernel;
  using Parameters = GaussianParameters;
  using Moments = GaussianMoments;
  using Step = GaussianStep;
  static constexpr std::string_view profile = "3dgs";
  static constexpr const auto& kinds = gaussian_parameter_kinds;
  static constexpr auto tile_functions = &gaussian_tile_functions;
  static constexpr auto step_functions = &gaussian_step_functions;

  /// The constants of a step after the fraction `done` of the run, without the rates.
  static Step step_of(const Config& config, double half_side, double done, std::size_t count);

  /// The densification after `step` steps, the one with this number, from 1 on.
  static DensifyReport densify(const Config& config, int step, int number, Random& random,
                               Parameters& parameters, SplatMemory& memory);

  /// A factor of the rate of positions.
  static float position_rate(const Parameters&) { return 1; }

  /// Gaussians need no limits after a step.
  static void limit(const Config&, int, Parameters&) {}

  /// The first splats are round; discs have random orientations. A size is their standard
  /// deviation. Random splats: a quarter of their mean spacing. At points: the mean distance to
  /// this many others (as 3DGS), if it is between the lowest and the highest scale; coincident
  /// points have distance 0.
  static constexpr std::size_t neighbours = 3;
  static double size_of_share(const Config&, double side) { return side / 4; }
  static double size_at_point(const Config& config, double distance, double spacing,
                              double half_side);
  static void put(const Config& config, const ColoredPoint& point, double size, Random& random,
                  std::size_t place, Parameters& parameters);

  /// The splats that a viewer can draw: finite, and not too transparent.
  static Primitives primitives(const Config& config, const Parameters& parameters,
                               std::span<const float> evident);
};

using GaussianTrainer = SplatTrainer<GaussianTraining>;

/// For GaussianConfig::flat. Discs have the parameters of Gaussians; their third scale stays the
/// smallest one.
struct DiscTraining : GaussianTraining {
  using Kernel = splatting::DiscKernel;
  using Moments = DiscMoments;
  static constexpr std::string_view profile = "2dgs";
  static constexpr auto tile_functions = &disc_tile_functions;
  static constexpr auto step_functions = &disc_step_functions;
};

/// Calls act<DiscTraining>() or act<GaussianTraining>(), by config.flat.
template <class Act>
decltype(auto) with_training(const GaussianConfig& config, const Act& act) {
  return config.flat ? act.template operator()<DiscTraining>()
                     : act.template operator()<GaussianTraining>();
}

}  // namespace tureen::trainer
