// The backward pass from the image to the parameters of triangle windows, and their step by Adam,
// for the vectors of the processor, chosen at run time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "splatting/image_view.hpp"
#include "trainer/splats/splat_adam.hpp"
#include "trainer/splats/splat_memory.hpp"
#include "trainer/splats/windows/window_parameters.hpp"
#include "trainer/splats/windows/window_tile_kernels.hpp"

namespace tureen::trainer {

/// The results of a view's tiles.
struct WindowBackwardInput {
  splatting::ImageView view;
  int degree;                              // of the harmonics that were drawn
  std::span<const PairSpan> pairs;         // of each splat; empty if it is not drawn
  std::span<const WindowMoments> moments;  // of the pairs
};

/// A loss of the drawn splats themselves, beside that of the image: the sum over them of
///   opacity * o + sigma * s + inverse_area / area.
/// o is the opacity, s the sigma, the area in layer units squared. Triangle Splatting, section 3.4,
/// has the means of o and of 1 / area over all splats.
struct WindowLoss {
  float opacity = 0, sigma = 0, inverse_area = 0;
};

/// The derivatives by the trained values of the splats [begin, end): rows of window_row. `begin` is
/// a multiple of splatting::row_alignment. Splats that are not drawn have zeros.
void window_gradients(const WindowBackwardInput& input, const WindowLoss& loss,
                      const WindowParameters& parameters, std::size_t begin, std::size_t end,
                      splatting::ParameterRows& gradients);

struct WindowStep {
  float rates[5];  // as window_parameter_kinds
  SplatAdam adam = {};
  WindowLoss loss = {};
};

/// window_gradients(), and a step by Adam of the drawn splats, and their statistics. Splats with a
/// gradient that is not finite, or beyond 1e18, do not move; returns their number.
/// splat_statistic::motion sums the derivatives by the images of the three corners.
std::size_t step_windows(const WindowBackwardInput& input, const WindowStep& step,
                         std::size_t begin, std::size_t end, WindowParameters& parameters,
                         SplatMemory& memory);

}  // namespace tureen::trainer
