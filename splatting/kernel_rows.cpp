#include "splatting/kernel_rows.hpp"

#include <algorithm>
#include <vector>

#include "splatting/gaussians/gaussian_kernels.hpp"
#include "splatting/neural/neural_kernels.hpp"

namespace tureen::splatting {

void write_kernel_rows(const SplatKernel& kernel, std::size_t i, std::span<float> out) {
  auto next = out.begin();
  for_each_column(kernel, [&](const auto& column) {
    if (column.role == ColumnRole::label) return;
    const std::span<const float> values = column.of_splat(i);
    next = std::copy(values.begin(), values.end(), next);
  });
  if (const auto* gaussians = std::get_if<Gaussians>(&kernel); gaussians && gaussians->flat)
    out[gaussian_row::scale_z] = 0;
  if (const auto* densities = std::get_if<NeuralDensities>(&kernel))
    for (std::size_t row = neural_row::frequencies; row < neural_row::amplitudes; ++row)
      out[row] *= densities->omega;
}

std::size_t kernel_rows(const SplatKernel& kernel) {
  std::size_t rows = 0;
  for_each_column(kernel, [&](const auto& column) {
    if (column.role != ColumnRole::label) rows += column.of_splat(0).size();
  });
  return rows;
}

ParameterRows rows_of(const Splats& splats, std::span<const std::uint32_t> which, int degree) {
  const std::size_t of_kernel = kernel_rows(splats.kernel);
  const SplatColor& color = splats.color;
  const std::size_t colors = color.per_corner ? 3 : 1, of_color = harmonics_rows(degree);
  const std::size_t stored = harmonics::count(color.degree);
  ParameterRows rows(of_kernel + colors * of_color, which.size());
  std::vector<float> values(of_kernel);
  for (std::size_t i = 0; i < which.size(); ++i) {
    write_kernel_rows(splats.kernel, which[i], values);
    for (std::size_t row = 0; row < of_kernel; ++row) rows.row(row)[i] = values[row];
    for (std::size_t c = 0; c < colors; ++c) {
      const glm::vec3* coefficients = &color.coefficients[(which[i] * colors + c) * stored];
      for (std::size_t k = 0; k < of_color; ++k)
        rows.row(of_kernel + c * of_color + k)[i] = coefficients[k / 3][int(k % 3)];
    }
  }
  return rows;
}

}  // namespace tureen::splatting
