// The backward pass from the image to the parameters of splats, and their step by Adam (Kingma and
// Ba 2015), for the vectors of the processor, chosen at run time.
#pragma once

#include <cstddef>
#include <span>

#include "splatting/image_view.hpp"
#include "splatting/parameter_rows.hpp"
#include "trainer/splats/splat_memory.hpp"

namespace tureen::trainer {

/// epsilon is that of 3DGS's code: far below typical gradients.
struct SplatAdam {
  float beta1 = 0.9f, beta2 = 0.999f;
  float epsilon = 1e-15f;
};

/// The results of a view's tiles.
template <class Moments>
struct BackwardInput {
  splatting::ImageView view;         // without keep_integral
  int degree;                        // of the harmonics that were drawn
  std::span<const PairSpan> pairs;   // of each splat; empty if it is not drawn
  std::span<const Moments> moments;  // of the pairs
};

/// `Step` has the rates of the table of parameters, `adam`, and constants of the kernel.
template <class Moments, class Step, class Parameters>
struct StepFunctions {
  /// The derivatives by the trained values of the splats [begin, end), in rows as the drawn ones.
  /// `begin` is a multiple of splatting::row_alignment. Splats that are not drawn have zeros.
  void (*gradients)(const BackwardInput<Moments>& input, const Step& step,
                    const Parameters& parameters, std::size_t begin, std::size_t end,
                    splatting::ParameterRows& gradients);
  /// A step by Adam of the drawn splats along these derivatives, and their statistics. Splats with
  /// a derivative that is not finite, or beyond 1e18, do not move; returns their number.
  std::size_t (*step)(const BackwardInput<Moments>& input, const Step& step, std::size_t begin,
                      std::size_t end, Parameters& parameters, SplatMemory& memory);
};

}  // namespace tureen::trainer
