#include "runtime/splats/splat_source.hpp"

#include <array>
#include <cassert>
#include <cstring>
#include <glm/vec4.hpp>

#include "base/error.hpp"
#include "scene/spherical_harmonics.hpp"

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

}  // namespace tureen
