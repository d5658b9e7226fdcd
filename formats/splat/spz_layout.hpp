// What the reader and the writer of SPZ share; spz.hpp describes the format.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "scene/spherical_harmonics.hpp"

namespace tureen {

inline constexpr std::uint32_t spz_magic = 0x5053474e;  // "NGSP"
inline constexpr std::size_t gzip_header_size = 16, plain_header_size = 32, spz_table_row = 16;
inline constexpr unsigned flag_antialiased = 1, flag_extensions = 2;

/// The arrays, in the order of the file. rest: harmonics from degree 1 on.
namespace spz_array {
inline constexpr std::size_t positions = 0, alphas = 1, colors = 2, scales = 3, rotations = 4,
                             rest = 5, count = 6;
}

/// The sign of each harmonic after half a turn about x. Entry l * l + l + m is that of Y_lm, which
/// is odd in y for m < 0, and odd in z for odd l - |m|.
inline std::array<float, harmonics::count(harmonics::max_degree)> signs_after_turn() {
  std::array<float, harmonics::count(harmonics::max_degree)> signs;
  for (int l = 0; l <= harmonics::max_degree; ++l)
    for (int m = -l; m <= l; ++m)
      signs[std::size_t(l * l + l + m)] = (m < 0) != ((l - std::abs(m)) % 2 == 1) ? -1.0f : 1.0f;
  // Niantic's program, which writes these files, also changes the sign of Y_44.
  signs.back() = -1.0f;
  return signs;
}

}  // namespace tureen
