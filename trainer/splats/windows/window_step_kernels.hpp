// The backward pass from the image to the parameters of triangle windows, and their step by Adam,
// for the vectors of the processor, chosen at run time.
#pragma once

#include "trainer/splats/splat_step.hpp"
#include "trainer/splats/windows/window_parameters.hpp"
#include "trainer/splats/windows/window_tile_kernels.hpp"

namespace tureen::trainer {

/// A loss of the drawn splats themselves, beside that of the image: the sum over them of
///   opacity * o + sigma * s + inverse_area / area.
/// o is the opacity, s the sigma, the area in layer units squared. Triangle Splatting, section 3.4,
/// has the means of o and of 1 / area over all splats.
struct WindowLoss {
  float opacity = 0, sigma = 0, inverse_area = 0;
};

struct WindowStep {
  float rates[5];  // as window_parameter_kinds
  SplatAdam adam = {};
  WindowLoss loss = {};
};

/// splat_statistic::motion sums the derivatives by the images of the three corners.
const StepFunctions<WindowMoments, WindowStep, WindowParameters>& window_step_functions();

}  // namespace tureen::trainer
