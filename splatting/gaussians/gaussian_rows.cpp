#include "splatting/gaussians/gaussian_kernels.hpp"
#include "splatting/harmonics_rows.hpp"

namespace tureen::splatting {

ParameterRows rows_of(const Gaussians& gaussians, const SplatColor& color,
                      std::span<const std::uint32_t> which, int degree) {
  namespace row = gaussian_row;
  ParameterRows rows(row::harmonics + harmonics_rows(degree), which.size());
  for (std::size_t i = 0; i < which.size(); ++i) {
    const std::uint32_t splat = which[i];
    for (int axis = 0; axis < 3; ++axis) {
      rows.row(row::x + std::size_t(axis))[i] = gaussians.centers[splat][axis];
      rows.row(row::scale_x + std::size_t(axis))[i] =
          gaussians.flat && axis == 2 ? 0.0f : gaussians.scales[splat][axis];
    }
    const glm::quat& rotation = gaussians.rotations[splat];
    rows.row(row::rotation_x)[i] = rotation.x;
    rows.row(row::rotation_y)[i] = rotation.y;
    rows.row(row::rotation_z)[i] = rotation.z;
    rows.row(row::rotation_w)[i] = rotation.w;
    rows.row(row::opacity)[i] = gaussians.opacity[splat];
  }
  write_harmonics(color, which, degree, rows, row::harmonics);
  return rows;
}

}  // namespace tureen::splatting
