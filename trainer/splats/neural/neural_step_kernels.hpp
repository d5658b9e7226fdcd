// The backward pass from the image to the parameters of neural densities, and their step by Adam,
// for the vectors of the processor, chosen at run time.
#pragma once

#include "trainer/splats/neural/neural_parameters.hpp"
#include "trainer/splats/neural/neural_tile_kernels.hpp"
#include "trainer/splats/splat_step.hpp"

namespace tureen::trainer {

struct NeuralStep {
  float rates[9];  // as neural_parameter_kinds
  SplatAdam adam = {};
  float min_log_axis, max_log_axis;
  /// A loss of the drawn splats beside that of the image: the sum over them of this times the
  /// standard deviation of the three semi-axes, over the smallest. The authors' code has the mean
  /// over all splats; the paper does not divide by the smallest.
  float anisotropy = 0;
};

/// splat_statistic::motion sums the derivatives by the image of the centre.
const StepFunctions<NeuralMoments, NeuralStep, NeuralParameters>& neural_step_functions();

}  // namespace tureen::trainer
