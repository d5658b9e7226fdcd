// The parameters of Gaussians in training. One table lists their names, sizes, activations, rates,
// and their values after a split.
#pragma once

#include <array>
#include <cstddef>

#include "scene/splats.hpp"
#include "splatting/gaussian_kernels.hpp"
#include "splatting/parameter_rows.hpp"
#include "trainer/splats/parameter_kinds.hpp"

namespace tureen::trainer {

/// The table, for harmonics of the highest degree. Rates are for runs of a few thousand steps,
/// chosen on held-out training views (tests/bench/train_gaussians.cpp, held_out=1). They begin
/// above those of 3DGS (arXiv 2308.04079), whose code takes 30,000 steps: log scale 5e-3, rotation
/// 1e-3, opacity logit 5e-2, harmonics 2.5e-3 and 1.25e-4.
extern const std::array<ParameterKind, 6> gaussian_parameter_kinds;

/// Values of splats. Rows are gaussian_row's, with harmonics up to `degree`.
struct GaussianParameters {
  /// Rows of gaussian_row whose trained values differ from the drawn ones.
  static constexpr std::size_t first_raw = splatting::gaussian_row::scale_x;
  static constexpr std::size_t raw_rows = splatting::gaussian_row::harmonics - first_raw;

  int degree = 0;
  splatting::ParameterRows drawn;  // after activation
  splatting::ParameterRows raw;    // raw_rows rows: logarithms of scales, any quaternion, logits

  GaussianParameters() = default;
  GaussianParameters(std::size_t count, int degree);
  /// Opacities are limited to [0.001, 0.999], and scales to 1e-30 or more.
  GaussianParameters(const Gaussians& gaussians, const SplatColor& color, int degree);

  std::size_t count() const { return drawn.count(); }
  std::size_t rows() const;
  /// The trained values of a row of gaussian_row.
  float* trained(std::size_t row);
  const float* trained(std::size_t row) const;
  /// Computes the drawn values of splat `i`.
  void activate(std::size_t i);

  /// Splat i becomes the one at order[i]. `order`: each index once.
  void reorder(std::span<const std::uint32_t> order);

  /// As a scene stores them, with the profile "3dgs".
  Splats splats() const;
};

}  // namespace tureen::trainer
