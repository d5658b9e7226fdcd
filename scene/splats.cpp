#include "scene/splats.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "scene/finite.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen {

namespace {

using Profile = SplatProfile;

constexpr Profile triangle_splatting{.min_center_depth = published_center_depth};
constexpr Profile gaussians_3d{.low_pass = Profile::LowPass::dilation,
                               .min_center_depth = published_center_depth};
constexpr Profile gaussians_2d{.projection = Profile::Projection::plane,
                               .low_pass = Profile::LowPass::screen,
                               .min_center_depth = published_center_depth};

template <class T>
std::size_t vector_bytes(const std::vector<T>& values) {
  return values.size() * sizeof(T);
}

bool is_fraction(float value) { return value >= 0 && value <= 1; }

/// Readers normalise in single precision; the rounding is below 1e-6.
bool has_unit_length(const glm::quat& q) { return std::abs(glm::dot(q, q) - 1.0f) <= 1e-5f; }

struct SplatBox {
  glm::vec3 low{std::numeric_limits<float>::max()};
  glm::vec3 high{std::numeric_limits<float>::lowest()};

  void add(const glm::vec3& point) {
    if (!is_finite(point)) return;
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
  void add(const glm::dvec3& center, const glm::dvec3& extent) {
    add(glm::vec3(center - extent));
    add(glm::vec3(center + extent));
  }
  Bounds bounds() const { return low.x <= high.x ? Bounds{low, high} : Bounds{}; }
};

/// Half the box around the ellipsoid with these semi-axes.
glm::dvec3 extent_of(const glm::quat& rotation, const glm::dvec3& semi_axes) {
  const glm::dmat3 axes = glm::mat3_cast(glm::dquat(rotation));
  glm::dvec3 squared(0.0);
  for (int i = 0; i < 3; ++i) {
    const glm::dvec3 axis = axes[i] * semi_axes[i];
    squared += axis * axis;
  }
  return glm::sqrt(squared);
}

/// Adds what splat `i` covers to a box.
struct AddToBox {
  const Profile& profile;
  SplatBox& box;

  void operator()(const TriangleWindows& windows, std::size_t i) const {
    if (windows.opacity[i] >= profile.min_alpha)
      for (std::size_t corner = 0; corner < 3; ++corner) box.add(windows.corners[3 * i + corner]);
  }

  void operator()(const Gaussians& gaussians, std::size_t i) const {
    const double squared = 2 * std::log(double(gaussians.opacity[i]) / double(profile.min_alpha));
    if (!(squared >= 0)) return;
    glm::dvec3 axes(gaussians.scales[i]);
    if (gaussians.flat) axes.z = 0;
    box.add(gaussians.centers[i], extent_of(gaussians.rotations[i], std::sqrt(squared) * axes));
  }

  void operator()(const NeuralDensities& densities, std::size_t i) const {
    box.add(densities.centers[i], extent_of(densities.rotations[i], densities.semi_axes[i]));
  }
};

using SplatDefect = std::optional<std::string>;

std::string at(std::size_t splat, const char* what) {
  return "splat " + std::to_string(splat) + " has " + what;
}

struct FindKernelDefect {
  SplatDefect operator()(const TriangleWindows& windows) const {
    const std::size_t splats = windows.opacity.size();
    if (windows.corners.size() != 3 * splats || windows.sigma.size() != splats)
      return "the windows have " + std::to_string(windows.corners.size()) + " corners and " +
             std::to_string(windows.sigma.size()) + " sigmas for " + std::to_string(splats) +
             " opacities";
    for (std::size_t i = 0; i < splats; ++i) {
      for (std::size_t corner = 0; corner < 3; ++corner)
        if (!is_finite(windows.corners[3 * i + corner]))
          return at(i, "a corner that is not finite");
      if (!(windows.sigma[i] > 0) || !std::isfinite(windows.sigma[i]))
        return at(i, "a sigma that is not positive and finite");
      if (!is_fraction(windows.opacity[i])) return at(i, "an opacity outside 0..1");
    }
    return {};
  }

  SplatDefect operator()(const Gaussians& gaussians) const {
    const std::size_t splats = gaussians.centers.size();
    if (gaussians.scales.size() != splats || gaussians.rotations.size() != splats ||
        gaussians.opacity.size() != splats)
      return "the Gaussians have " + std::to_string(gaussians.scales.size()) + " scales, " +
             std::to_string(gaussians.rotations.size()) + " rotations and " +
             std::to_string(gaussians.opacity.size()) + " opacities for " + std::to_string(splats) +
             " centres";
    for (std::size_t i = 0; i < splats; ++i) {
      if (!is_finite(gaussians.centers[i])) return at(i, "a centre that is not finite");
      const glm::vec3& scales = gaussians.scales[i];
      if (!is_finite(scales) || scales.x < 0 || scales.y < 0 || scales.z < 0)
        return at(i, "a scale that is negative or not finite");
      if (!has_unit_length(gaussians.rotations[i]))
        return at(i, "a rotation that is not of unit length");
      if (!is_fraction(gaussians.opacity[i])) return at(i, "an opacity outside 0..1");
    }
    return {};
  }

  SplatDefect operator()(const NeuralDensities& densities) const {
    const std::size_t splats = densities.centers.size();
    if (densities.semi_axes.size() != splats || densities.rotations.size() != splats ||
        densities.networks.size() != NeuralDensities::parameters * splats)
      return "the neural densities have " + std::to_string(densities.semi_axes.size()) +
             " semi-axes, " + std::to_string(densities.rotations.size()) + " rotations and " +
             std::to_string(densities.networks.size()) + " network parameters for " +
             std::to_string(splats) + " centres";
    for (std::size_t i = 0; i < splats; ++i) {
      if (!is_finite(densities.centers[i])) return at(i, "a centre that is not finite");
      const glm::vec3& axes = densities.semi_axes[i];
      if (!is_finite(axes) || !(axes.x > 0 && axes.y > 0 && axes.z > 0))
        return at(i, "a semi-axis that is not positive and finite");
      if (!has_unit_length(densities.rotations[i]))
        return at(i, "a rotation that is not of unit length");
    }
    for (std::size_t k = 0; k < densities.networks.size(); ++k)
      if (!std::isfinite(densities.networks[k]))
        return at(k / NeuralDensities::parameters, "a network parameter that is not finite");
    if (!std::isfinite(densities.omega)) return "omega is not finite";
    return {};
  }
};

SplatDefect find_splat_defect(const SplatColor& color, const SplatKernel& kernel,
                              std::size_t splats) {
  if (color.per_corner && !std::holds_alternative<TriangleWindows>(kernel))
    return "only triangle windows have colours of corners";
  if (color.degree < 0 || color.degree > harmonics::max_degree)
    return "harmonics of degree " + std::to_string(color.degree) + " are outside 0..4";
  const std::size_t per_splat = coefficients_per_splat(color);
  if (color.coefficients.size() != per_splat * splats)
    return std::to_string(color.coefficients.size()) + " harmonics coefficients, expected " +
           std::to_string(per_splat * splats);
  const auto bad =
      std::find_if_not(color.coefficients.begin(), color.coefficients.end(), is_finite<float>);
  if (bad == color.coefficients.end()) return {};
  return at(std::size_t(bad - color.coefficients.begin()) / per_splat,
            "a harmonics coefficient that is not finite");
}

}  // namespace

std::size_t coefficients_per_splat(const SplatColor& color) {
  return std::size_t(harmonics::count(color.degree)) * (color.per_corner ? 3 : 1);
}

const std::array<NamedProfile, 8> named_profiles{{
    {"3dgs", gaussians_3d},
    {"mip", {.low_pass = Profile::LowPass::mip, .min_center_depth = published_center_depth}},
    {"2dgs", gaussians_2d},
    {"games", gaussians_3d},
    // It traces rays.
    {"redisplats",
     {.projection = Profile::Projection::plane, .max_alpha = 1.0f, .stop_transmittance = 0.0f}},
    {"triangle-splatting", triangle_splatting},
    {"mesh-splatting", {.max_alpha = 0.999f, .min_center_depth = published_center_depth}},
    {"splatnet", triangle_splatting},
}};

std::optional<SplatProfile> profile_named(std::string_view name) {
  for (const NamedProfile& each : named_profiles)
    if (each.name == name) return each.profile;
  return {};
}

std::string_view name_of(const SplatProfile& profile) {
  for (const NamedProfile& each : named_profiles)
    if (each.profile == profile) return each.name;
  return "custom";
}

std::optional<std::string> profile_defect(const SplatKernel& kernel, const SplatProfile& profile) {
  if (!(profile.max_alpha > 0 && profile.max_alpha <= 1))
    return "the largest alpha is outside 0..1";
  // 0 would give a Gaussian no end.
  if (!(profile.min_alpha >= 1e-6f && profile.min_alpha < 1))
    return "the smallest alpha is outside 1e-6..1";
  if (!(profile.stop_transmittance >= 0 && profile.stop_transmittance < 1))
    return "the transmittance that ends a pixel is outside 0..1";
  if (!(profile.min_center_depth >= 0 && std::isfinite(profile.min_center_depth)))
    return "the smallest depth of a centre is negative or not finite";
  const bool on_plane = profile.projection == Profile::Projection::plane;
  const auto* gaussians = std::get_if<Gaussians>(&kernel);
  if (!gaussians && (on_plane || profile.low_pass != Profile::LowPass::none))
    return std::string(kernel_name(kernel)) + " have neither another projection nor a low pass";
  if (on_plane && !gaussians->flat) return "only flat Gaussians can be projected on their plane";
  if (profile.low_pass == Profile::LowPass::screen && !on_plane)
    return "the low pass of 2DGS needs projection on the plane";
  if (on_plane &&
      (profile.low_pass == Profile::LowPass::dilation || profile.low_pass == Profile::LowPass::mip))
    return "dilation needs the projection by EWA";
  return {};
}

const std::vector<float>* opacity_of(const SplatKernel& kernel) {
  if (const auto* windows = std::get_if<TriangleWindows>(&kernel)) return &windows->opacity;
  if (const auto* gaussians = std::get_if<Gaussians>(&kernel)) return &gaussians->opacity;
  return nullptr;
}

int degree_in_use(const SplatColor& color) {
  const std::size_t per_splat = harmonics::count(color.degree);
  int degree = 0;
  for (std::size_t i = 0; i < color.coefficients.size() && degree < color.degree; ++i) {
    if (color.coefficients[i] == glm::vec3(0.0f)) continue;
    while (i % per_splat >= std::size_t(harmonics::count(degree))) ++degree;
  }
  return degree;
}

bool is_transparent(const Splats& splats) {
  const std::vector<float>* opacity = opacity_of(splats.kernel);
  return opacity && !opacity->empty() &&
         std::none_of(opacity->begin(), opacity->end(),
                      [&](float each) { return each >= splats.profile.min_alpha; });
}

std::size_t count(const Splats& splats) {
  if (const auto* windows = std::get_if<TriangleWindows>(&splats.kernel))
    return windows->opacity.size();
  if (const auto* gaussians = std::get_if<Gaussians>(&splats.kernel))
    return gaussians->centers.size();
  return std::get<NeuralDensities>(splats.kernel).centers.size();
}

const char* kernel_name(const SplatKernel& kernel) {
  if (std::holds_alternative<TriangleWindows>(kernel)) return "triangle windows";
  if (const auto* gaussians = std::get_if<Gaussians>(&kernel))
    return gaussians->flat ? "flat Gaussians" : "Gaussians";
  return "neural densities";
}

std::string describe(const Splats& splats) {
  return std::to_string(count(splats)) + " " + kernel_name(splats.kernel) + ", profile " +
         std::string(profile_name(splats)) + ", harmonics of degree " +
         std::to_string(splats.color.degree) + (splats.color.per_corner ? " per corner" : "");
}

std::string_view profile_name(const SplatKernel& kernel, const SplatProfile& profile) {
  const std::string_view name = name_of(profile);
  if (std::holds_alternative<NeuralDensities>(kernel) && name == "triangle-splatting")
    return "splatnet";
  const auto* gaussians = std::get_if<Gaussians>(&kernel);
  return gaussians && gaussians->flat && name == "3dgs" ? "games" : name;
}

std::string_view profile_name(const Splats& splats) {
  return profile_name(splats.kernel, splats.profile);
}

glm::dvec3 center(const Splats& splats, std::size_t i) {
  if (const auto* windows = std::get_if<TriangleWindows>(&splats.kernel)) {
    const glm::vec3* corner = &windows->corners[3 * i];
    return (glm::dvec3(corner[0]) + glm::dvec3(corner[1]) + glm::dvec3(corner[2])) / 3.0;
  }
  if (const auto* gaussians = std::get_if<Gaussians>(&splats.kernel)) return gaussians->centers[i];
  return std::get<NeuralDensities>(splats.kernel).centers[i];
}

Bounds bounds(const Splats& splats) {
  SplatBox box;
  std::visit(
      [add = AddToBox{splats.profile, box}, all = count(splats)](const auto& kernel) {
        for (std::size_t i = 0; i < all; ++i) add(kernel, i);
      },
      splats.kernel);
  return box.bounds();
}

Bounds bounds(const Splats& splats, std::span<const std::uint32_t> which,
              const SplatProfile& profile) {
  SplatBox box;
  std::visit(
      [add = AddToBox{profile, box}, which](const auto& kernel) {
        for (const std::uint32_t i : which) add(kernel, i);
      },
      splats.kernel);
  return box.bounds();
}

std::size_t byte_size(const Splats& splats) {
  std::size_t bytes = vector_bytes(splats.color.coefficients);
  if (const auto* windows = std::get_if<TriangleWindows>(&splats.kernel))
    return bytes + vector_bytes(windows->corners) + vector_bytes(windows->sigma) +
           vector_bytes(windows->opacity);
  if (const auto* gaussians = std::get_if<Gaussians>(&splats.kernel))
    return bytes + vector_bytes(gaussians->centers) + vector_bytes(gaussians->scales) +
           vector_bytes(gaussians->rotations) + vector_bytes(gaussians->opacity);
  const auto& densities = std::get<NeuralDensities>(splats.kernel);
  return bytes + vector_bytes(densities.centers) + vector_bytes(densities.semi_axes) +
         vector_bytes(densities.rotations) + vector_bytes(densities.networks);
}

std::size_t bytes_per_splat(const SplatKernel& kernel, int degree) {
  constexpr std::size_t ellipsoid = 2 * sizeof(glm::vec3) + sizeof(glm::quat);
  const std::size_t shape = std::holds_alternative<TriangleWindows>(kernel)
                                ? 3 * sizeof(glm::vec3) + 2 * sizeof(float)
                            : std::holds_alternative<Gaussians>(kernel)
                                ? ellipsoid + sizeof(float)
                                : ellipsoid + NeuralDensities::parameters * sizeof(float);
  return shape + std::size_t(harmonics::count(degree)) * sizeof(glm::vec3);
}

std::size_t keep_windows(Splats& splats, const std::function<bool(std::size_t)>& keeps) {
  auto& [corners, sigma, opacity] = std::get<TriangleWindows>(splats.kernel);
  std::vector<glm::vec3>& coefficients = splats.color.coefficients;
  const std::size_t each = coefficients_per_splat(splats.color);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < opacity.size(); ++i) {
    if (!keeps(i)) continue;
    if (kept != i) {
      std::copy_n(&corners[3 * i], 3, &corners[3 * kept]);
      sigma[kept] = sigma[i];
      opacity[kept] = opacity[i];
      std::copy_n(&coefficients[each * i], each, &coefficients[each * kept]);
    }
    ++kept;
  }
  corners.resize(3 * kept);
  sigma.resize(kept);
  opacity.resize(kept);
  coefficients.resize(each * kept);
  return kept;
}

std::optional<std::string> defect(const Splats& splats) {
  if (SplatDefect reason = profile_defect(splats.kernel, splats.profile)) return reason;
  if (SplatDefect reason = std::visit(FindKernelDefect{}, splats.kernel)) return reason;
  return find_splat_defect(splats.color, splats.kernel, count(splats));
}

}  // namespace tureen
