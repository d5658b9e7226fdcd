// The backward pass from the image to the parameters of discs, and their step by Adam, for the
// vectors of the processor, chosen at run time. Discs have the parameters of Gaussians; their scale
// along z has the derivative 0.
#pragma once

#include <cstddef>
#include <span>

#include "splatting/image_view.hpp"
#include "trainer/splats/discs/disc_tile_kernels.hpp"
#include "trainer/splats/gaussians/gaussian_step_kernels.hpp"

namespace tureen::trainer {

/// The results of a view's tiles, as GaussianBackwardInput.
struct DiscBackwardInput {
  splatting::ImageView view;
  int degree;
  std::span<const PairSpan> pairs;
  std::span<const DiscMoments> moments;
};

/// gaussian_gradients() of discs.
void disc_gradients(const DiscBackwardInput& input, const GaussianParameters& parameters,
                    std::size_t begin, std::size_t end, splatting::ParameterRows& gradients);

/// step_gaussians() of discs.
std::size_t step_discs(const DiscBackwardInput& input, const GaussianStep& step, std::size_t begin,
                       std::size_t end, GaussianParameters& parameters, SplatMemory& memory);

}  // namespace tureen::trainer
