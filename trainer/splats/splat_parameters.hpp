// Values of splats in training, for any kernel: those that are drawn, and those that are trained.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "scene/spherical_harmonics.hpp"
#include "scene/splats.hpp"
#include "splatting/kernel_rows.hpp"
#include "splatting/parameter_rows.hpp"
#include "trainer/splats/splat_order.hpp"

namespace tureen::trainer {

/// The rows of a kernel, with harmonics up to `degree` from the row `Harmonics` on. From `FirstRaw`
/// to `EndRaw` (excluded), trained values differ from drawn ones.
template <std::size_t FirstRaw, std::size_t Harmonics, std::size_t EndRaw = Harmonics>
struct SplatParameters {
  static constexpr std::size_t raw_rows = EndRaw - FirstRaw;

  int degree = 0;
  splatting::ParameterRows drawn;  // after activation
  splatting::ParameterRows raw;    // raw_rows rows

  SplatParameters() = default;
  SplatParameters(std::size_t count, int degree_of_harmonics)
      : degree(degree_of_harmonics),
        drawn(Harmonics + splatting::harmonics_rows(degree_of_harmonics), count),
        raw(raw_rows, count) {}
  /// Drawn values of splats of the kernel, with one colour each. Other harmonics are 0.
  SplatParameters(const Splats& splats, int degree_of_harmonics)
      : SplatParameters(tureen::count(splats), degree_of_harmonics) {
    std::vector<std::uint32_t> all(count());
    std::iota(all.begin(), all.end(), 0u);
    const splatting::ParameterRows values =
        splatting::rows_of(splats, all, std::min(degree, splats.color.degree));
    for (std::size_t row = 0; row < values.rows(); ++row)
      std::copy_n(values.row(row), count(), drawn.row(row));
  }

  std::size_t count() const { return drawn.count(); }
  std::size_t rows() const { return Harmonics + splatting::harmonics_rows(degree); }

  /// The trained values of a row.
  float* trained(std::size_t row) { return const_cast<float*>(std::as_const(*this).trained(row)); }
  const float* trained(std::size_t row) const {
    return row >= FirstRaw && row < EndRaw ? raw.row(row - FirstRaw) : drawn.row(row);
  }

  /// Of the trained and the drawn values.
  bool is_finite(std::size_t splat) const {
    for (std::size_t row = 0; row < rows(); ++row)
      if (!std::isfinite(trained(row)[splat]) || !std::isfinite(drawn.row(row)[splat]))
        return false;
    return true;
  }

  /// The colour from all directions, display-referred, of a splat without other harmonics.
  void set_color(std::size_t splat, const glm::vec3& color) {
    for (int channel = 0; channel < 3; ++channel)
      trained(Harmonics + std::size_t(channel))[splat] =
          float((double(color[channel]) - 0.5) / harmonics::y00);
  }

  /// The trained values of one splat become those of another one.
  void copy(std::size_t from, std::size_t to) {
    for (std::size_t row = 0; row < rows(); ++row) trained(row)[to] = trained(row)[from];
  }

  /// Zeros for the splats from count() on.
  void enlarge(std::size_t new_count) {
    drawn = enlarged(drawn, rows(), new_count);
    raw = enlarged(raw, raw_rows, new_count);
  }

  /// Splat i becomes the one at order[i]; the others are removed. `order`: each index at most once.
  void reorder(std::span<const std::uint32_t> order) {
    drawn = reordered(drawn, rows(), order);
    raw = reordered(raw, raw_rows, order);
  }

  /// Three drawn values of a splat, from `row` on.
  glm::vec3 triple(std::size_t row, std::size_t splat) const {
    return {drawn.row(row)[splat], drawn.row(row + 1)[splat], drawn.row(row + 2)[splat]};
  }

  /// The colours, as a scene stores them.
  SplatColor color() const {
    SplatColor color{.degree = degree};
    for (std::size_t i = 0; i < count(); ++i)
      for (std::size_t row = Harmonics; row < rows(); row += 3)
        color.coefficients.push_back(triple(row, i));
    return color;
  }
};

}  // namespace tureen::trainer
