// The parameters of neural densities in training (Splat the Net, arXiv 2510.08491). One table lists
// their names, sizes and rates.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "scene/splats.hpp"
#include "splatting/neural/neural_kernels.hpp"
#include "trainer/splats/parameter_kinds.hpp"
#include "trainer/splats/splat_parameters.hpp"

namespace tureen::trainer {

/// The first bytes of a checkpoint of neural densities.
inline constexpr std::array<char, 8> neural_magic{'T', 'U', 'R', 'E', 'E', 'N', 'N', 'D'};

/// The table, for harmonics of the highest degree. Rates are for reference_count splats; see
/// NeuralTraining::rate_factor. The rates of frequencies and phases are times omega, 30.
extern const std::array<ParameterKind, 9> neural_parameter_kinds;

/// Rows are neural_row's. Trained values are logarithms of semi-axes, and quaternions of any
/// length; networks are trained as they are drawn, with frequencies and phases times omega.
struct NeuralParameters
    : SplatParameters<splatting::neural_row::semi_axes, splatting::neural_row::harmonics,
                      splatting::neural_row::frequencies> {
  using SplatParameters::SplatParameters;
  /// Of neural densities. Semi-axes are limited to 1e-30 or more.
  NeuralParameters(const Splats& splats, int degree);

  /// For splats_in_bytes(). With photographs of lego at 200x200 that were held back from training,
  /// degrees 0, 1 and 2 give 24.0, 24.5 and 24.1 dB in 0.1 MB after 1,500 steps. Beyond, not
  /// measured.
  static constexpr std::array<std::uint64_t, 3> least_of_degree{1, 200, 1000};

  /// Computes the drawn values of splat `i`.
  void activate(std::size_t i);
  glm::vec3 center(std::size_t i) const { return triple(splatting::neural_row::center, i); }
  /// For densify_splats(): only images show whether a density is dead.
  static float opacity(std::size_t) { return 1; }

  /// As a scene stores them, with the profile "splatnet".
  Splats splats() const;
};

/// Values of the network of a splat, from neural_row::frequencies on.
inline constexpr std::size_t network_rows = NeuralDensities::parameters;

}  // namespace tureen::trainer
