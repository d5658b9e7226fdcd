// Neural densities as a method of SplatTrainer: Splat the Net (arXiv 2510.08491).
//
// It differs from the authors' code where measurements are better (docs/neural-training.md):
// densities that no image shows take the places of halves of others, halves keep the density of the
// whole, rates fall during the run and with the number of densities, and the first densities are
// trained Gaussians.
#pragma once

#include <span>

#include "scene/scene.hpp"
#include "trainer/splats/neural/neural_config.hpp"
#include "trainer/splats/neural/neural_densify.hpp"
#include "trainer/splats/neural/neural_step_kernels.hpp"
#include "trainer/splats/splat_trainer.hpp"

namespace tureen::trainer {

struct NeuralTraining {
  using Config = NeuralConfig;
  using Kernel = splatting::NeuralKernel;
  using Parameters = NeuralParameters;
  using Moments = NeuralMoments;
  using Step = NeuralStep;
  static constexpr std::string_view profile = "splatnet";
  static constexpr const auto& kinds = neural_parameter_kinds;
  static constexpr auto tile_functions = &neural_tile_functions;
  static constexpr auto step_functions = &neural_step_functions;

  /// The constants of a step after the fraction `done` of the run, without the rates.
  static Step step_of(const Config& config, double half_side, double done, std::size_t count);

  /// A factor of the rate of a row of `kinds`. Many densities are small, and need small steps. Up
  /// to reference_count, 1. Fitted to the best rates of two prototypes, with 1,282 and 10,100.
  static float rate_factor(const Config& config, std::size_t kind, std::size_t count);
  static float position_rate(const Parameters&) { return 1; }
  static constexpr double reference_count = 1282;

  /// The densification after `step` steps, the one with this number, from 1 on.
  static DensifyReport densify(const Config& config, int step, int number, Random& random,
                               Parameters& parameters, SplatMemory& memory);

  /// Neural densities need no limits after a step.
  static void limit(const Config&, int, Parameters&) {}

  /// The first densities are balls. A size is their radius: half of the side of a cube that is a
  /// splat's share of the volume, and at points the mean distance to this many others, between the
  /// shortest and the longest semi-axis.
  static constexpr std::size_t neighbours = 3;
  static double size_of_share(const Config&, double side) { return side / 2; }
  static double size_at_point(const Config& config, double distance, double spacing,
                              double half_side);
  static void put(const Config& config, const ColoredPoint& point, double size, Random& random,
                  std::size_t place, Parameters& parameters);

  /// The splats that are finite.
  static Primitives primitives(const Config& config, const Parameters& parameters,
                               std::span<const float> evident);
};

using NeuralTrainer = SplatTrainer<NeuralTraining>;

/// Calls act<NeuralTraining>().
template <class Act>
decltype(auto) with_training(const NeuralConfig&, const Act& act) {
  return act.template operator()<NeuralTraining>();
}

}  // namespace tureen::trainer
