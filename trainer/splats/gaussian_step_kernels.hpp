// The backward pass from the image to the parameters of Gaussians, and their step by Adam, for the
// vectors of the processor, chosen at run time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "splatting/image_view.hpp"
#include "trainer/splats/gaussian_parameters.hpp"
#include "trainer/splats/gaussian_tile_kernels.hpp"

namespace tureen::trainer {

/// Consecutive pairs of a splat and a tile.
struct PairRange {
  std::uint32_t begin, end;
};

/// The results of a view's tiles.
struct GaussianBackwardInput {
  splatting::ImageView view;                 // without keep_integral
  int degree;                                // of the harmonics that were drawn
  std::span<const PairRange> pairs;          // of each splat; empty if it is not drawn
  std::span<const GaussianMoments> moments;  // of the pairs
};

/// The derivatives by the trained values of the splats [begin, end): rows of gaussian_row. `begin`
/// is a multiple of splatting::row_alignment. Splats that are not drawn have zeros.
void gaussian_gradients(const GaussianBackwardInput& input, const GaussianParameters& parameters,
                        std::size_t begin, std::size_t end, splatting::ParameterRows& gradients);

/// The state of Adam and of the densifier, for each splat; zeros at first.
struct GaussianMemory {
  /// A value of row_alignment consecutive splats.
  struct alignas(64) Line {
    float values[splatting::row_alignment];
  };
  /// For each block of splats and each row: the first moments, then the second ones.
  std::vector<Line> moments;
  splatting::ParameterRows statistics;  // rows of gaussian_statistic

  GaussianMemory() = default;
  explicit GaussianMemory(const GaussianParameters& parameters);
};

/// Rows of GaussianMemory::statistics.
namespace gaussian_statistic {
enum : std::size_t {
  steps,    // of Adam
  motion,   // sum over steps of |dL / d image of the centre|, per pixel
  evident,  // > 0: some pixel had at least evident_weight
  count
};
}

struct GaussianStep {
  float rates[6];  // as gaussian_parameter_kinds
  float beta1 = 0.9f, beta2 = 0.999f;
  float epsilon = 1e-15f;
  float min_log_scale, max_log_scale;
};

/// gaussian_gradients(), and a step by Adam of the drawn splats, and their statistics. Splats with
/// a gradient that is not finite, or beyond 1e18, do not move; returns their number.
std::size_t step_gaussians(const GaussianBackwardInput& input, const GaussianStep& step,
                           std::size_t begin, std::size_t end, GaussianParameters& parameters,
                           GaussianMemory& memory);

}  // namespace tureen::trainer
