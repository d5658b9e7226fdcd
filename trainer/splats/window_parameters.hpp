// The parameters of triangle windows in training (Triangle Splatting, arXiv 2505.19175). One table
// lists their names, sizes, activations, rates, and their values after a split.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "scene/splats.hpp"
#include "splatting/parameter_rows.hpp"
#include "splatting/window_kernels.hpp"
#include "trainer/splats/parameter_kinds.hpp"

namespace tureen::trainer {

/// The table, for harmonics of the highest degree. Activations are those of the paper's code. Rates
/// are for about 5,000 steps; those of the code are for 30,000.
extern const std::array<ParameterKind, 5> window_parameter_kinds;

/// The lowest sigma, and the range of log(sigma - sigma_floor) in training: from 0.1 % above the
/// lowest sigma to a sigma of 20, where the mean of rho^sigma is 0.4 % of the peak.
inline constexpr float sigma_floor = 0.01f;
inline constexpr float min_log_sigma = -11.5f, max_log_sigma = 3.0f;
/// Beyond, the sigmoid is 1 in single precision, and its derivative 0.
inline constexpr float max_logit = 16.0f;

/// Values of splats. Rows are window_row's, with harmonics up to `degree`.
struct WindowParameters {
  /// Rows of window_row whose trained values differ from the drawn ones.
  static constexpr std::size_t first_raw = splatting::window_row::sigma;
  static constexpr std::size_t raw_rows = splatting::window_row::harmonics - first_raw;

  int degree = 0;
  /// Opacities are min_opacity + (1 - min_opacity) sigmoid(logit), in [0, 1): 0, except while the
  /// windows become opaque.
  float min_opacity = 0;
  splatting::ParameterRows drawn;  // after activation
  splatting::ParameterRows raw;    // raw_rows rows: logarithms of sigma - sigma_floor, logits

  WindowParameters() = default;
  WindowParameters(std::size_t count, int degree);
  /// Opacities are limited to [0.001, 0.999], and sigmas to at least 1.01 sigma_floor.
  WindowParameters(const TriangleWindows& windows, const SplatColor& color, int degree);

  std::size_t count() const { return drawn.count(); }
  std::size_t rows() const;
  /// The trained values of a row of window_row.
  float* trained(std::size_t row);
  const float* trained(std::size_t row) const;
  /// Computes the drawn values of splat `i`.
  void activate(std::size_t i);
  /// The trained values for a drawn sigma and a drawn opacity, limited as in the constructor.
  static float log_of_sigma(float sigma);
  float logit_of(float opacity) const;

  /// Splat i becomes the one at order[i]. `order`: each index once.
  void reorder(std::span<const std::uint32_t> order);

  /// As a scene stores them, with the profile "triangle-splatting".
  Splats splats() const;
};

}  // namespace tureen::trainer
