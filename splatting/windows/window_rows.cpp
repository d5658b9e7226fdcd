#include "splatting/harmonics_rows.hpp"
#include "splatting/windows/window_kernels.hpp"

namespace tureen::splatting {

ParameterRows rows_of(const TriangleWindows& windows, const SplatColor& color,
                      std::span<const std::uint32_t> which, int degree) {
  const std::size_t colors = color.per_corner ? 3 : 1;
  ParameterRows rows(window_row::harmonics + colors * harmonics_rows(degree), which.size());
  for (std::size_t i = 0; i < which.size(); ++i) {
    for (std::size_t k = 0; k < 9; ++k)
      rows.row(window_row::corners + k)[i] = windows.corners[3 * which[i] + k / 3][int(k % 3)];
    rows.row(window_row::sigma)[i] = windows.sigma[which[i]];
    rows.row(window_row::opacity)[i] = windows.opacity[which[i]];
  }
  write_harmonics(color, which, degree, rows, window_row::harmonics);
  return rows;
}

}  // namespace tureen::splatting
