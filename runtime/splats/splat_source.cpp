#include "runtime/splats/splat_source.hpp"

#include <algorithm>
#include <cstring>
#include <glm/vec4.hpp>
#include <numeric>
#include <span>
#include <utility>

#include "scene/spherical_harmonics.hpp"
#include "splatting/kernel.hpp"
#include "splatting/kernel_rows.hpp"

namespace tureen {

namespace {

TexelSource kernel_source(const Splats& splats, const SplatPlan& plan) {
  const std::span<const std::size_t> rows = splatting::facts_of(plan.kind).texel_rows;
  const std::uint32_t* drawn = plan.drawn.data();  // stays when the plan is moved
  return {.format = texel_formats::rgba32f,
          .count = rows.size() / 4 * plan.drawn.size(),
          .what = "splats",
          .fill = [&kernel = splats.kernel, drawn, rows](std::uint64_t first,
                                                         std::span<std::byte> out) {
            std::vector<float> values(splatting::kernel_rows(kernel));
            std::uint64_t written = ~std::uint64_t(0);
            const std::size_t each = rows.size() / 4;
            for (std::size_t at = 0; at < out.size(); at += sizeof(glm::vec4), ++first) {
              const std::uint64_t splat = first / each;
              if (splat != written) splatting::write_kernel_rows(kernel, drawn[splat], values);
              written = splat;
              glm::vec4 texel;
              for (int k = 0; k < 4; ++k) {
                const std::size_t row = rows[first % each * 4 + std::size_t(k)];
                texel[k] = row == splatting::no_row ? 0.0f : values[row];
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
              const float value =
                  row == splatting::no_row ? 0.0f : values.row(row)[at / rows.size()];
              std::memcpy(&out[i], &value, sizeof value);
            }
          }};
}

/// The centre of splat `i`: the mean of its points.
glm::vec3 center(const splatting::LayerData& layer, std::size_t i) {
  const std::size_t points = splatting::facts_of(layer.kind).points;
  glm::dvec3 sum(0.0);
  for (std::size_t row = 0; row < 3 * points; ++row)
    sum[int(row % 3)] += double(layer.rows.row(row)[i]);
  return sum / double(points);
}

}  // namespace

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
  const splatting::KernelFacts& facts = splatting::facts_of(layer.kind);
  std::vector<std::size_t> harmonics(facts.colors * splatting::harmonics_rows(layer.degree));
  std::iota(harmonics.begin(), harmonics.end(), layer.rows.rows() - harmonics.size());
  SplatSource source;
  source.kernel = row_source(layer.rows, {facts.texel_rows.begin(), facts.texel_rows.end()},
                             texel_formats::rgba32f, "splats");
  source.coefficients =
      row_source(layer.rows, std::move(harmonics), texel_formats::rgb32f, "harmonics");
  source.layout = layout.fitted(std::max(source.kernel.count, source.coefficients.count));
  source.centers.reserve(layer.rows.count());
  for (std::size_t i = 0; i < layer.rows.count(); ++i) source.centers.push_back(center(layer, i));
  return source;
}

}  // namespace tureen
