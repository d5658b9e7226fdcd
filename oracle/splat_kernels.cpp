#include "oracle/splat_kernels.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

#include "scene/spherical_harmonics.hpp"

namespace tureen::oracle {

std::optional<SplatInView> project(const Splats& splats, std::size_t i, const SplatView& view) {
  const SplatProfile& profile = splats.profile;
  if (profile.projection == SplatProfile::Projection::plane)
    return DiscInView::project(std::get<Gaussians>(splats.kernel), i, profile, view);
  return std::visit(
      [&](const auto& kernel) -> std::optional<SplatInView> {
        return decltype(in_view(kernel))::project(kernel, i, profile, view);
      },
      splats.kernel);
}

SplatSample sample(const SplatInView& splat, const glm::dvec2& pixel, double opaque_depth) {
  const SplatSample result = std::visit(
      [&](const auto& each) {
        if constexpr (requires { each.at(pixel, opaque_depth); })
          return each.at(pixel, opaque_depth);
        else
          return each.at(pixel);
      },
      splat);
  // The negations also remove NaN, which only overflow can give.
  if (!(result.depth < opaque_depth) || !(result.alpha > 0) || !(result.order <= result.order))
    return {};
  return result;
}

const ImageBox& box_of(const SplatInView& splat) {
  return std::visit([](const auto& each) -> const ImageBox& { return each.box(); }, splat);
}

namespace {

/// The colour of `element`, a splat or a corner, whose place is `from_eye`.
glm::dvec3 color_of(const SplatColor& color, std::size_t element, const glm::dvec3& from_eye) {
  const double distance = glm::length(from_eye);
  const auto basis = harmonics::basis(distance > 0 ? from_eye / distance : glm::dvec3(0, 0, 1));
  const std::size_t bands = harmonics::count(color.degree);
  glm::dvec3 sum(0.5);
  for (std::size_t k = 0; k < bands; ++k)
    sum += basis[k] * glm::dvec3(color.coefficients[element * bands + k]);
  // This order of the arguments turns NaN into 0.
  for (int c = 0; c < 3; ++c) sum[c] = std::max(0.0, sum[c]);
  return sum;
}

}  // namespace

SplatColorInView::SplatColorInView(const Splats& splats, std::size_t i, const glm::dvec3& eye)
    : per_corner_(splats.color.per_corner) {
  if (!per_corner_) {
    colors_[0] = color_of(splats.color, i, center(splats, i) - eye);
    return;
  }
  const glm::vec3* corners = &std::get<TriangleWindows>(splats.kernel).corners[3 * i];
  for (std::size_t k = 0; k < 3; ++k)
    colors_[k] = color_of(splats.color, 3 * i + k, glm::dvec3(corners[k]) - eye);
}

glm::dvec3 SplatColorInView::at(const SplatInView& splat, const glm::dvec2& pixel) const {
  if (!per_corner_) return colors_[0];
  const std::array<double, 3> weights = std::get<WindowInView>(splat).corner_weights(pixel);
  return weights[0] * colors_[0] + weights[1] * colors_[1] + weights[2] * colors_[2];
}

}  // namespace tureen::oracle
