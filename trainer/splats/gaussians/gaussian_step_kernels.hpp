// The backward pass from the image to the parameters of Gaussians, and their step by Adam, for the
// vectors of the processor, chosen at run time.
#pragma once

#include "trainer/splats/gaussians/gaussian_parameters.hpp"
#include "trainer/splats/gaussians/gaussian_tile_kernels.hpp"
#include "trainer/splats/splat_step.hpp"

namespace tureen::trainer {

struct GaussianStep {
  float rates[6];  // as gaussian_parameter_kinds
  SplatAdam adam = {};
  float min_log_scale, max_log_scale;
};

const StepFunctions<GaussianMoments, GaussianStep, GaussianParameters>& gaussian_step_functions();

}  // namespace tureen::trainer
