// Harmonics of splats as rows: red, green and blue of each coefficient, colour by colour.
#pragma once

#include <cstdint>
#include <span>

#include "scene/spherical_harmonics.hpp"
#include "scene/splats.hpp"
#include "splatting/parameter_rows.hpp"

namespace tureen::splatting {

/// Of one colour.
inline std::size_t harmonics_rows(int degree) { return 3 * std::size_t(harmonics::count(degree)); }

/// Writes the coefficients of these splats up to `degree` to the rows from `first` on: those of the
/// splats, or of their first corners, their second and their third.
inline void write_harmonics(const SplatColor& color, std::span<const std::uint32_t> which,
                            int degree, ParameterRows& rows, std::size_t first) {
  const std::size_t stored = harmonics::count(color.degree), used = harmonics::count(degree);
  const std::size_t colors = color.per_corner ? 3 : 1;
  for (std::size_t i = 0; i < which.size(); ++i)
    for (std::size_t c = 0; c < colors; ++c)
      for (std::size_t k = 0; k < used; ++k)
        for (int channel = 0; channel < 3; ++channel)
          rows.row(first + c * harmonics_rows(degree) + 3 * k + std::size_t(channel))[i] =
              color.coefficients[(which[i] * colors + c) * stored + k][channel];
}

}  // namespace tureen::splatting
