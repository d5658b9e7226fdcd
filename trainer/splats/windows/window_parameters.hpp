// The parameters of triangle windows in training (Triangle Splatting, arXiv 2505.19175). One table
// lists their names, sizes and rates.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "scene/splats.hpp"
#include "splatting/windows/window_kernels.hpp"
#include "trainer/splats/parameter_kinds.hpp"
#include "trainer/splats/splat_parameters.hpp"

namespace tureen::trainer {

/// The first bytes of a checkpoint of triangle windows.
inline constexpr std::array<char, 8> triangles_magic{'T', 'U', 'R', 'E', 'E', 'N', 'T', 'W'};

/// The table, for harmonics of the highest degree. Rates are for about 5,000 steps; those of the
/// paper's code are for 30,000.
extern const std::array<ParameterKind, 5> window_parameter_kinds;

/// The lowest sigma, and the range of log(sigma - sigma_floor) in training: from 0.1 % above the
/// lowest sigma to a sigma of 20, where the mean of rho^sigma is 0.4 % of the peak.
inline constexpr float sigma_floor = 0.01f;
inline constexpr float min_log_sigma = -11.5f, max_log_sigma = 3.0f;
/// Beyond, the sigmoid is 1 in single precision, and its derivative 0.
inline constexpr float max_logit = 16.0f;

/// Rows are window_row's. Trained values are logarithms of sigma - sigma_floor, and logits of
/// opacities.
struct WindowParameters
    : SplatParameters<splatting::window_row::sigma, splatting::window_row::harmonics> {
  /// From 0, soft windows, to 1 (excluded), opaque triangles. Opacities are solidity +
  /// (1 - solidity) sigmoid(logit), and windows have edges as
  /// splatting/windows/window_plane-inl.hpp says.
  float solidity = 0;

  using SplatParameters::SplatParameters;
  /// Opacities are limited to [0.001, 0.999], and sigmas to at least 1.01 sigma_floor.
  WindowParameters(const Splats& splats, int degree);

  /// For splats_in_bytes(). On held-out training views of lego at 200x200, degree 0 has 1.1, 0.7
  /// and 0.2 dB more than degree 1 in 0.4, 1 and 2.4 MB, and degree 1 has 1.9, 1.3 and 0.6 dB more
  /// than degree 2. Extrapolated, the differences vanish at these numbers of splats.
  static constexpr std::array<std::uint64_t, 3> least_of_degree{1, 40000, 40000};

  /// Computes the drawn values of splat `i`.
  void activate(std::size_t i);
  glm::vec3 corner(std::size_t i, std::size_t k) const {
    return triple(splatting::window_row::corners + 3 * k, i);
  }
  glm::vec3 center(std::size_t i) const {
    return (corner(i, 0) + corner(i, 1) + corner(i, 2)) / 3.0f;
  }
  float opacity(std::size_t i) const { return drawn.row(splatting::window_row::opacity)[i]; }
  /// The trained values for a drawn sigma and a drawn opacity, limited as in the constructor.
  static float log_of_sigma(float sigma);
  float logit_of(float opacity) const;

  /// As a scene stores them, with the profile "triangle-splatting".
  Splats splats() const;
};

}  // namespace tureen::trainer
