#include "scene/splats.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <numeric>

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

using SplatDefect = std::optional<std::string>;

/// Readers normalise in single precision; the rounding is below 1e-6.
bool has_unit_length(std::span<const float> xyzw) {
  const glm::quat q(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
  return std::abs(glm::dot(q, q) - 1.0f) <= 1e-5f;
}

bool is_inside(ColumnRange range, std::span<const float> values) {
  if (range == ColumnRange::unit_length) return has_unit_length(values);
  return std::all_of(values.begin(), values.end(), [&](float value) {
    if (range == ColumnRange::fraction) return value >= 0 && value <= 1;
    return std::isfinite(value) && (range == ColumnRange::finite || value > 0 ||
                                    (range == ColumnRange::not_negative && value == 0));
  });
}

/// What a value outside its ColumnRange is.
constexpr std::array<const char*, 5> outside{
    " that is not finite", " that is not positive and finite", " that is negative or not finite",
    " outside 0..1", " that is not of unit length"};

/// "scale", "network parameter".
std::string value_name(const auto& column) {
  const bool is_part = column.role == ColumnRole::value && column.per_splat > 1;
  return column.name + std::string(is_part ? " parameter" : "");
}

std::string at(std::size_t splat, const std::string& what) {
  return "splat " + std::to_string(splat) + " has a" +
         (std::strchr("aeiou", what.front()) ? "n " : " ") + what;
}

SplatDefect find_kernel_defect(const SplatKernel& kernel, std::size_t i) {
  SplatDefect result;
  for_each_column(kernel, [&](const auto& column) {
    if (!result && !is_inside(column.range, column.of_splat(i)))
      result = at(i, value_name(column) + outside[std::size_t(column.range)]);
  });
  return result;
}

SplatDefect find_size_defect(const SplatKernel& kernel, std::size_t splats) {
  std::vector<std::string> sizes;
  bool is_good = true;
  for_each_column(kernel, [&](const auto& column) {
    is_good = is_good && column.values.size() == column.per_splat * splats;
    sizes.push_back(std::to_string(column.values.size()) + " " + plural(value_name(column)));
  });
  if (is_good) return {};
  std::string text = std::string("the ") + kernel_name(kernel) + " have " + sizes[1];
  for (std::size_t k = 2; k < sizes.size(); ++k)
    text += (k + 1 < sizes.size() ? ", " : " and ") + sizes[k];
  return text + " for " + sizes[0];
}

SplatDefect find_kernel_defect(const SplatKernel& kernel) {
  const std::size_t splats = count(kernel);
  if (SplatDefect reason = find_size_defect(kernel, splats)) return reason;
  for (std::size_t i = 0; i < splats; ++i)
    if (SplatDefect reason = find_kernel_defect(kernel, i)) return reason;
  SplatDefect result;
  const auto check = [&](const char* name, float value) {
    if (!std::isfinite(value)) result = std::string(name) + " is not finite";
  };
  std::visit([&](const auto& each) { for_each_constant(each, check); }, kernel);
  return result;
}

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
            "harmonics coefficient that is not finite");
}

}  // namespace

std::size_t coefficients_per_splat(const SplatColor& color) {
  return std::size_t(harmonics::count(color.degree)) * (color.per_corner ? 3 : 1);
}

constexpr NamedProfile all_profiles[] = {
    {"3dgs", gaussians_3d},
    {"mip", {.low_pass = Profile::LowPass::mip, .min_center_depth = published_center_depth}},
    {"2dgs", gaussians_2d},
    {"games", gaussians_3d, "flat Gaussians"},
    // It traces rays.
    {"redisplats",
     {.projection = Profile::Projection::plane, .max_alpha = 1.0f, .stop_transmittance = 0.0f}},
    {"triangle-splatting", triangle_splatting},
    {"mesh-splatting", {.max_alpha = 0.999f, .min_center_depth = published_center_depth}},
    {"splatnet", triangle_splatting, "neural densities"},
};
constinit const std::span<const NamedProfile> named_profiles(all_profiles);

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
  const std::vector<float>* result = nullptr;
  for_each_column(kernel, [&](const auto& column) {
    if constexpr (requires { result = &column.values; })
      if (column.role == ColumnRole::opacity) result = &column.values;
  });
  return result;
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

std::size_t count(const SplatKernel& kernel) {
  std::optional<std::size_t> result;
  for_each_column(kernel, [&](const auto& column) {
    if (!result) result = column.values.size() / column.per_splat;
  });
  return *result;
}

std::size_t count(const Splats& splats) { return count(splats.kernel); }

const char* kernel_name(const SplatKernel& kernel) {
  return std::visit([](const auto& each) { return kernel_name(each); }, kernel);
}

std::string describe(const Splats& splats) {
  return std::to_string(count(splats)) + " " + kernel_name(splats.kernel) + ", profile " +
         std::string(profile_name(splats)) + ", harmonics of degree " +
         std::to_string(splats.color.degree) + (splats.color.per_corner ? " per corner" : "");
}

std::string_view profile_name(const SplatKernel& kernel, const SplatProfile& profile) {
  for (const NamedProfile& each : named_profiles)
    if (each.profile == profile && each.kernel == kernel_name(kernel)) return each.name;
  return name_of(profile);
}

std::string_view profile_name(const Splats& splats) {
  return profile_name(splats.kernel, splats.profile);
}

glm::dvec3 center(const Splats& splats, std::size_t i) {
  glm::dvec3 result(0.0);
  for_each_column(splats.kernel, [&](const auto& column) {
    if constexpr (requires { result = column.values[0]; }) {
      if (column.role != ColumnRole::position && column.role != ColumnRole::corner) return;
      const glm::vec3* points = &column.values[column.per_splat * i];
      result = points[0];
      for (std::size_t k = 1; k < column.per_splat; ++k) result += glm::dvec3(points[k]);
      result /= double(column.per_splat);
    }
  });
  return result;
}

Bounds bounds(const Splats& splats) {
  SplatBox box;
  std::visit(
      [&, all = count(splats)](const auto& kernel) {
        for (std::size_t i = 0; i < all; ++i) add_to_box(kernel, i, splats.profile.min_alpha, box);
      },
      splats.kernel);
  return box.bounds();
}

Bounds bounds(const Splats& splats, std::span<const std::uint32_t> which,
              const SplatProfile& profile) {
  SplatBox box;
  std::visit(
      [&](const auto& kernel) {
        for (const std::uint32_t i : which) add_to_box(kernel, i, profile.min_alpha, box);
      },
      splats.kernel);
  return box.bounds();
}

std::size_t byte_size(const Splats& splats) {
  std::size_t bytes = splats.color.coefficients.size() * sizeof(glm::vec3);
  for_each_column(splats.kernel, [&](const auto& column) {
    bytes += column.values.size() * sizeof column.values[0];
  });
  return bytes;
}

std::size_t bytes_per_splat(const SplatKernel& kernel, int degree) {
  std::size_t bytes = std::size_t(harmonics::count(degree)) * sizeof(glm::vec3);
  for_each_column(kernel,
                  [&](const auto& column) { bytes += column.per_splat * sizeof column.values[0]; });
  return bytes;
}

void number_rows(Splats& splats) {
  splats.rows.resize(count(splats));
  std::iota(splats.rows.begin(), splats.rows.end(), 0u);
}

bool is_valid(const Splats& splats, std::size_t i) {
  const std::size_t each = coefficients_per_splat(splats.color);
  const glm::vec3* first = splats.color.coefficients.data() + each * i;
  return !find_kernel_defect(splats.kernel, i) &&
         std::all_of(first, first + each, is_finite<float>);
}

std::optional<std::string> defect(const Splats& splats) {
  if (SplatDefect reason = profile_defect(splats.kernel, splats.profile)) return reason;
  if (SplatDefect reason = find_kernel_defect(splats.kernel)) return reason;
  return find_splat_defect(splats.color, splats.kernel, count(splats));
}

}  // namespace tureen
