#include "runtime/splats/splat_source.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>
#include <glm/vec4.hpp>
#include <numeric>
#include <span>
#include <utility>

#include "base/error.hpp"
#include "scene/spherical_harmonics.hpp"
#include "splatting/gaussians/gaussian_kernels.hpp"
#include "splatting/kernel_rows.hpp"
#include "splatting/neural/neural_kernels.hpp"
#include "splatting/windows/window_kernels.hpp"

namespace tureen {

namespace {

/// Kernels, by the rows of their layers.
enum class RowsOf { windows, gaussians, densities };

RowsOf rows_of(SplatShaders shaders) {
  if (shaders == SplatShaders::windows) return RowsOf::windows;
  return shaders == SplatShaders::neural_density ? RowsOf::densities : RowsOf::gaussians;
}

RowsOf rows_of(splatting::LayerKind kind) {
  using Kind = splatting::LayerKind;
  if (kind == Kind::windows || kind == Kind::corner_color_windows) return RowsOf::windows;
  return kind == Kind::densities ? RowsOf::densities : RowsOf::gaussians;
}

/// Where a value that is 0 for all splats is read.
constexpr std::size_t no_row = ~std::size_t(0);

/// The layout of a splat's kernel texels: the row of each component.
std::vector<std::size_t> kernel_rows(RowsOf kernel) {
  namespace window = splatting::window_row;
  namespace gaussian = splatting::gaussian_row;
  namespace neural = splatting::neural_row;
  std::vector<std::size_t> rows;
  const auto add = [&](std::size_t first, std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) rows.push_back(first + k);
  };
  switch (kernel) {
    case RowsOf::windows:
      add(window::corners, 3);
      rows.push_back(window::sigma);
      add(window::corners + 3, 3);
      rows.push_back(window::opacity);
      add(window::corners + 6, 3);
      rows.push_back(no_row);
      break;
    case RowsOf::gaussians:
      add(gaussian::x, 3);
      rows.push_back(gaussian::opacity);
      add(gaussian::scale_x, 3);
      rows.push_back(no_row);
      add(gaussian::rotation_x, 4);
      break;
    case RowsOf::densities:
      add(neural::center, 3);
      rows.push_back(no_row);
      add(neural::semi_axes, 3);
      rows.push_back(neural::offset);
      add(neural::rotation, 4);
      for (std::size_t k = 0; k < NeuralDensities::width; ++k) {
        add(neural::frequencies + 3 * k, 3);
        rows.push_back(neural::phases + k);
      }
      add(neural::amplitudes, NeuralDensities::width);
      break;
  }
  return rows;
}

TexelSource kernel_source(const Splats& splats, const SplatPlan& plan) {
  std::vector<std::size_t> rows = kernel_rows(rows_of(plan.shaders));
  const std::uint32_t* drawn = plan.drawn.data();  // stays when the plan is moved
  return {.format = texel_formats::rgba32f,
          .count = rows.size() / 4 * plan.drawn.size(),
          .what = "splats",
          .fill = [&kernel = splats.kernel, drawn, rows = std::move(rows)](
                      std::uint64_t first, std::span<std::byte> out) {
            std::array<float, splatting::neural_row::harmonics> values{};  // the longest
            std::uint64_t written = ~std::uint64_t(0);
            const std::size_t each = rows.size() / 4;
            for (std::size_t at = 0; at < out.size(); at += sizeof(glm::vec4), ++first) {
              const std::uint64_t splat = first / each;
              if (splat != written) splatting::write_kernel_rows(kernel, drawn[splat], values);
              written = splat;
              glm::vec4 texel;
              for (int k = 0; k < 4; ++k) {
                const std::size_t row = rows[first % each * 4 + std::size_t(k)];
                texel[k] = row == no_row ? 0.0f : values[row];
              }
              std::memcpy(&out[at], &texel, sizeof texel);
            }
          }};
}

TexelSource coefficient_source(const Splats& splats, const SplatPlan& plan) {
  const std::size_t each = harmonics::count(plan.harmonics_degree);
  const auto colors = std::size_t(plan.colors_per_splat);
  const std::uint32_t* drawn = plan.drawn.data();
  return {.format = texel_formats::rgb32f,
          .count = each * colors * plan.drawn.size(),
          .what = "harmonics",
          .fill = [&color = splats.color, drawn, each, colors](std::uint64_t first,
                                                               std::span<std::byte> out) {
            const std::size_t stored = harmonics::count(color.degree);
            for (std::size_t at = 0; at < out.size(); at += sizeof(glm::vec3), ++first) {
              const std::uint64_t place = first / each;
              const std::size_t of_color = drawn[place / colors] * colors + place % colors;
              std::memcpy(&out[at], &color.coefficients[of_color * stored + first % each],
                          sizeof(glm::vec3));
            }
          }};
}

/// A source whose texels have the values of these rows in turn: the first `rows.size()` values are
/// those of splat 0.
TexelSource row_source(const splatting::ParameterRows& values, std::vector<std::size_t> rows,
                       const TexelFormat& format, std::string what) {
  return {format, rows.size() * sizeof(float) / format.bytes * values.count(), std::move(what),
          [&values, rows = std::move(rows), components = format.bytes / sizeof(float)](
              std::uint64_t first, std::span<std::byte> out) {
            std::uint64_t at = first * components;
            for (std::size_t i = 0; i < out.size(); i += sizeof(float), ++at) {
              const std::size_t row = rows[at % rows.size()];
              const float value = row == no_row ? 0.0f : values.row(row)[at / rows.size()];
              std::memcpy(&out[i], &value, sizeof value);
            }
          }};
}

/// The centre of splat `i`: the first rows of every kernel have points.
glm::vec3 center(const splatting::LayerData& layer, std::size_t i) {
  const auto point = [&](std::size_t row) {
    return glm::dvec3(layer.rows.row(row)[i], layer.rows.row(row + 1)[i],
                      layer.rows.row(row + 2)[i]);
  };
  if (rows_of(layer.kind) != RowsOf::windows) return point(0);
  return (point(0) + point(3) + point(6)) / 3.0;
}

}  // namespace

int kernel_texels(SplatShaders shaders) { return int(kernel_rows(rows_of(shaders)).size() / 4); }

SplatSource prepare_splats(const Splats& splats, const SplatPlan& plan, const TexelLayout& layout) {
  SplatSource source;
  source.kernel = kernel_source(splats, plan);
  source.coefficients = coefficient_source(splats, plan);
  source.layout = layout.fitted(std::max(source.kernel.count, source.coefficients.count));
  source.centers.reserve(plan.drawn.size());
  for (const std::uint32_t i : plan.drawn) source.centers.emplace_back(center(splats, i));
  return source;
}

SplatSource prepare_splats(const splatting::LayerData& layer, const TexelLayout& layout) {
  const std::size_t colors = layer.kind == splatting::LayerKind::corner_color_windows ? 3 : 1;
  std::vector<std::size_t> harmonics(colors * splatting::harmonics_rows(layer.degree));
  std::iota(harmonics.begin(), harmonics.end(), layer.rows.rows() - harmonics.size());
  SplatSource source;
  source.kernel =
      row_source(layer.rows, kernel_rows(rows_of(layer.kind)), texel_formats::rgba32f, "splats");
  source.coefficients =
      row_source(layer.rows, std::move(harmonics), texel_formats::rgb32f, "harmonics");
  source.layout = layout.fitted(std::max(source.kernel.count, source.coefficients.count));
  source.centers.reserve(layer.rows.count());
  for (std::size_t i = 0; i < layer.rows.count(); ++i) source.centers.push_back(center(layer, i));
  return source;
}

}  // namespace tureen
