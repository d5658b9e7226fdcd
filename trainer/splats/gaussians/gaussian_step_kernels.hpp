// The backward pass from the image to the parameters of Gaussians, and their step by Adam, for the
// vectors of the processor, chosen at run time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "splatting/image_view.hpp"
#include "trainer/splats/gaussians/gaussian_parameters.hpp"
#include "trainer/splats/gaussians/gaussian_tile_kernels.hpp"
#include "trainer/splats/splat_adam.hpp"
#include "trainer/splats/splat_memory.hpp"

namespace tureen::trainer {

/// The results of a view's tiles.
struct GaussianBackwardInput {
  splatting::ImageView view;                 // without keep_integral
  int degree;                                // of the harmonics that were drawn
  std::span<const PairSpan> pairs;           // of each splat; empty if it is not drawn
  std::span<const GaussianMoments> moments;  // of the pairs
};

/// The derivatives by the trained values of the splats [begin, end): rows of gaussian_row. `begin`
/// is a multiple of splatting::row_alignment. Splats that are not drawn have zeros.
void gaussian_gradients(const GaussianBackwardInput& input, const GaussianParameters& parameters,
                        std::size_t begin, std::size_t end, splatting::ParameterRows& gradients);

struct GaussianStep {
  float rates[6];  // as gaussian_parameter_kinds
  SplatAdam adam = {};
  float min_log_scale, max_log_scale;
};

/// gaussian_gradients(), and a step by Adam of the drawn splats, and their statistics. Splats with
/// a gradient that is not finite, or beyond 1e18, do not move; returns their number.
std::size_t step_gaussians(const GaussianBackwardInput& input, const GaussianStep& step,
                           std::size_t begin, std::size_t end, GaussianParameters& parameters,
                           SplatMemory& memory);

}  // namespace tureen::trainer
