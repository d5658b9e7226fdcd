// The parameters of Gaussians in training. One table lists their names, sizes and rates.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "scene/splats.hpp"
#include "splatting/gaussians/gaussian_kernels.hpp"
#include "trainer/splats/parameter_kinds.hpp"
#include "trainer/splats/splat_parameters.hpp"

namespace tureen::trainer {

/// The first bytes of a checkpoint of Gaussians or discs.
inline constexpr std::array<char, 8> gaussians_magic{'T', 'U', 'R', 'E', 'E', 'N', 'G', 'S'};

/// The table, for harmonics of the highest degree. Rates are for runs of a few thousand steps,
/// chosen on photographs that were held back from training. They begin above those of 3DGS (arXiv
/// 2308.04079), whose code takes 30,000 steps: log scale 5e-3, rotation 1e-3, opacity logit 5e-2,
/// harmonics 2.5e-3 and 1.25e-4.
extern const std::array<ParameterKind, 6> gaussian_parameter_kinds;

/// Rows are gaussian_row's. Trained values are logarithms of scales, quaternions of any length, and
/// logits of opacities.
struct GaussianParameters
    : SplatParameters<splatting::gaussian_row::scale_x, splatting::gaussian_row::harmonics> {
  using SplatParameters::SplatParameters;
  /// Opacities are limited to [0.001, 0.999], and scales to 1e-30 or more.
  GaussianParameters(const Splats& splats, int degree);

  /// For splats_in_bytes(). With photographs of lego at 200x200 that were held back from training,
  /// degrees 0, 1 and 2 give 26.8, 26.5 and 25.2 dB in 0.1 MB, 29.7, 30.0 and 29.1 dB in 0.4 MB; in
  /// 1 MB, 1 and 2 give 31.9 and 31.4 dB. Beyond, not measured.
  static constexpr std::array<std::uint64_t, 3> least_of_degree{1, 2500, 20000};

  /// Computes the drawn values of splat `i`.
  void activate(std::size_t i);
  glm::vec3 center(std::size_t i) const { return triple(splatting::gaussian_row::x, i); }
  float opacity(std::size_t i) const { return drawn.row(splatting::gaussian_row::opacity)[i]; }

  /// As a scene stores them: Gaussians of the profile "3dgs", or discs of "2dgs".
  Splats splats(bool flat = false) const;
};

}  // namespace tureen::trainer
