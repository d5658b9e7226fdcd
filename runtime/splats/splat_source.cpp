#include "runtime/splats/splat_source.hpp"

#include <array>
#include <cassert>
#include <cstring>
#include <glm/vec4.hpp>
#include <numeric>
#include <utility>

#include "base/error.hpp"
#include "scene/spherical_harmonics.hpp"
#include "splatting/gaussians/gaussian_kernels.hpp"
#include "splatting/neural/neural_kernels.hpp"
#include "splatting/windows/window_kernels.hpp"

namespace tureen {

namespace {

constexpr int neural_texels = 3 + NeuralDensities::width + NeuralDensities::width / 4;

using Texels = std::array<glm::vec4, neural_texels>;

struct WriteKernel {
  std::size_t i;
  Texels& out;

  void operator()(const TriangleWindows& windows) const {
    const glm::vec3* corners = &windows.corners[3 * i];
    out[0] = glm::vec4(corners[0], windows.sigma[i]);
    out[1] = glm::vec4(corners[1], windows.opacity[i]);
    out[2] = glm::vec4(corners[2], 0.0f);
  }
  void operator()(const Gaussians& gaussians) const {
    out[0] = glm::vec4(gaussians.centers[i], gaussians.opacity[i]);
    const glm::vec3& scales = gaussians.scales[i];
    out[1] = glm::vec4(scales.x, scales.y, gaussians.flat ? 0.0f : scales.z, 0.0f);
    out[2] = rotation(gaussians.rotations[i]);
  }
  void operator()(const NeuralDensities& densities) const {
    constexpr std::size_t width = NeuralDensities::width;
    const float* w = &densities.networks[NeuralDensities::parameters * i];
    const float *b1 = w + 3 * width, *a = b1 + width;
    out[0] = glm::vec4(densities.centers[i], 0.0f);
    out[1] = glm::vec4(densities.semi_axes[i], a[width]);
    out[2] = rotation(densities.rotations[i]);
    for (std::size_t k = 0; k < width; ++k)
      out[3 + k] = densities.omega * glm::vec4(w[3 * k], w[3 * k + 1], w[3 * k + 2], b1[k]);
    for (std::size_t k = 0; k < width; k += 4)
      out[3 + width + k / 4] = glm::vec4(a[k], a[k + 1], a[k + 2], a[k + 3]);
  }
  static glm::vec4 rotation(const glm::quat& q) { return {q.x, q.y, q.z, q.w}; }
};

TexelSource kernel_source(const Splats& splats, const SplatPlan& plan) {
  const auto each = std::size_t(kernel_texels(plan.shaders));
  const std::uint32_t* drawn = plan.drawn.data();  // stays when the plan is moved
  return {.format = texel_formats::rgba32f,
          .count = each * plan.drawn.size(),
          .what = "splats",
          .fill = [&kernel = splats.kernel, drawn, each](std::uint64_t first,
                                                         std::span<std::byte> out) {
            Texels texels{};
            std::uint64_t written = ~std::uint64_t(0);
            for (std::size_t at = 0; at < out.size(); at += sizeof(glm::vec4), ++first) {
              const std::uint64_t splat = first / each;
              if (splat != written) std::visit(WriteKernel{drawn[splat], texels}, kernel);
              written = splat;
              std::memcpy(&out[at], &texels[first % each], sizeof(glm::vec4));
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

/// Where a value that is 0 for all splats is read.
constexpr std::size_t no_row = ~std::size_t(0);

/// The rows of the components of a splat's kernel texels.
std::vector<std::size_t> kernel_rows(splatting::LayerKind kind) {
  using Kind = splatting::LayerKind;
  namespace window = splatting::window_row;
  namespace gaussian = splatting::gaussian_row;
  namespace neural = splatting::neural_row;
  std::vector<std::size_t> rows;
  const auto add = [&](std::size_t first, std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) rows.push_back(first + k);
  };
  switch (kind) {
    case Kind::windows:
    case Kind::corner_color_windows:
      add(window::corners, 3);
      rows.push_back(window::sigma);
      add(window::corners + 3, 3);
      rows.push_back(window::opacity);
      add(window::corners + 6, 3);
      rows.push_back(no_row);
      break;
    case Kind::discs:
    case Kind::gaussians:
      add(gaussian::x, 3);
      rows.push_back(gaussian::opacity);
      add(gaussian::scale_x, 3);
      rows.push_back(no_row);
      add(gaussian::rotation_x, 4);
      break;
    case Kind::densities:
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

std::size_t first_harmonics_row(splatting::LayerKind kind) {
  switch (kind) {
    case splatting::LayerKind::windows:
    case splatting::LayerKind::corner_color_windows:
      return splatting::window_row::harmonics;
    case splatting::LayerKind::densities:
      return splatting::neural_row::harmonics;
    default:
      return splatting::gaussian_row::harmonics;
  }
}

glm::vec3 center(const splatting::LayerData& layer, std::size_t i) {
  const auto point = [&](std::size_t row) {
    return glm::dvec3(layer.rows.row(row)[i], layer.rows.row(row + 1)[i],
                      layer.rows.row(row + 2)[i]);
  };
  switch (layer.kind) {
    case splatting::LayerKind::windows:
    case splatting::LayerKind::corner_color_windows: {
      const std::size_t first = splatting::window_row::corners;
      return (point(first) + point(first + 3) + point(first + 6)) / 3.0;
    }
    case splatting::LayerKind::densities:
      return point(splatting::neural_row::center);
    default:
      return point(splatting::gaussian_row::x);
  }
}

}  // namespace

int kernel_texels(SplatShaders shaders) {
  return shaders == SplatShaders::neural_density ? neural_texels : 3;
}

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
  const std::size_t first = first_harmonics_row(layer.kind);
  std::vector<std::size_t> harmonics(layer.rows.rows() - first);
  std::iota(harmonics.begin(), harmonics.end(), first);
  SplatSource source;
  source.kernel = row_source(layer.rows, kernel_rows(layer.kind), texel_formats::rgba32f, "splats");
  source.coefficients =
      row_source(layer.rows, std::move(harmonics), texel_formats::rgb32f, "harmonics");
  source.layout = layout.fitted(std::max(source.kernel.count, source.coefficients.count));
  source.centers.reserve(layer.rows.count());
  for (std::size_t i = 0; i < layer.rows.count(); ++i) source.centers.push_back(center(layer, i));
  return source;
}

}  // namespace tureen
