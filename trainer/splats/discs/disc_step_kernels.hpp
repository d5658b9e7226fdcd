// The backward pass from the image to the parameters of discs, and their step by Adam, for the
// vectors of the processor, chosen at run time. Discs have the parameters of Gaussians; their scale
// along z has the derivative 0.
#pragma once

#include "trainer/splats/discs/disc_tile_kernels.hpp"
#include "trainer/splats/gaussians/gaussian_step_kernels.hpp"

namespace tureen::trainer {

const StepFunctions<DiscMoments, GaussianStep, GaussianParameters>& disc_step_functions();

}  // namespace tureen::trainer
