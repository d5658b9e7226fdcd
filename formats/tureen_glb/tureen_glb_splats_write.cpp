#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string_view>
#include <type_traits>
#include <utility>

#include "base/error.hpp"
#include "formats/tureen_glb/tureen_glb_splats.hpp"
#include "formats/tureen_glb/tureen_glb_writing.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen {

std::string harmonics_attribute(int degree, int order) {
  // KHR_gaussian_splatting ends at degree 3.
  const char* prefix = degree > 3 ? glb_layout::splats_extension : glb_layout::splatting_extension;
  return std::string(prefix) + ":SH_DEGREE_" + std::to_string(degree) + "_COEF_" +
         std::to_string(order);
}

std::string attribute_key(ColumnRole role) {
  if (role == ColumnRole::position) return "POSITION";
  const char* attribute = role == ColumnRole::scale      ? ":SCALE"
                          : role == ColumnRole::rotation ? ":ROTATION"
                                                         : ":OPACITY";
  return glb_layout::splatting_extension + std::string(attribute);
}

namespace glb_writing {

namespace {

// glTF stores x, y, z, w.
static_assert(offsetof(glm::quat, x) == 0 && offsetof(glm::quat, w) == 3 * sizeof(float));

template <class Value>
constexpr const BinaryPlan::Format& format_of = sizeof(Value) == sizeof(glm::quat)   ? vec4_float
                                                : sizeof(Value) == sizeof(glm::vec3) ? vec3_float
                                                                                     : scalar_float;

/// KHR_gaussian_splatting requires an opacity, also of a kernel without.
std::vector<float> plain_opacities(const SplatKernel& kernel) {
  std::vector<float> opacity(count(kernel));
  std::visit(
      [&](const auto& each) {
        if constexpr (requires { plain_opacity(each, 0); })
          for (std::size_t i = 0; i < opacity.size(); ++i) opacity[i] = plain_opacity(each, i);
      },
      kernel);
  return opacity;
}

/// Adds the arrays of a primitive of points. `ours` is TUREEN_splats.
void add_columns(BinaryPlan& plan, json& attributes, json& ours, const SplatKernel& kernel) {
  bool lacks_opacity = !opacity_of(kernel);
  for_each_column(kernel, [&]<class Values>(const Column<Values>& column) {
    using Value = typename Values::value_type;
    const std::string key = column_key(column);
    if (!is_attribute(column) && std::exchange(lacks_opacity, false))
      plan.owned_accessor(attributes, attribute_key(ColumnRole::opacity).c_str(),
                          plain_opacities(kernel), scalar_float);
    plan.accessor(is_attribute(column) ? attributes : ours, key.c_str(), bytes_of(column.values),
                  format_of<Value>);
    if constexpr (std::is_same_v<Value, glm::vec3>)
      if (column.role == ColumnRole::position && !column.values.empty())
        add_range(plan.accessors[attributes[key].template get<std::size_t>()], column.values);
  });
  const auto add = [&](const char* name, float value) { ours[name] = value; };
  std::visit([&](const auto& each) { for_each_constant(each, add); }, kernel);
}

/// The colours for other viewers: the constant part of the harmonics, and the opacity.
std::vector<glm::u16vec4> point_colors(const Splats& splats) {
  const std::vector<float>* opacity = opacity_of(splats.kernel);
  const std::size_t stride = harmonics::count(splats.color.degree);
  std::vector<glm::u16vec4> colors(count(splats));
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const glm::vec3 constant = 0.5f + float(harmonics::y00) * splats.color.coefficients[stride * i];
    colors[i] =
        linear_unorm16(glm::clamp(constant, 0.0f, 1.0f), opacity ? double((*opacity)[i]) : 1.0);
  }
  return colors;
}

/// One attribute a coefficient, for all splats. Not interleaved: a stride has at most 252 bytes,
/// and degree 4 would need 300.
void add_coefficients(BinaryPlan& plan, json& attributes, const SplatColor& color) {
  const std::size_t stride = harmonics::count(color.degree);
  std::vector<glm::vec3> plane(color.coefficients.size() / stride);
  std::size_t k = 0;
  for (int degree = 0; degree <= color.degree; ++degree)
    for (int order = 0; order < 2 * degree + 1; ++order, ++k) {
      for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = color.coefficients[stride * i + k];
      plan.owned_accessor(attributes, harmonics_attribute(degree, order).c_str(), plane,
                          vec3_float);
    }
}

const char* stored_kernel(const SplatKernel& kernel) {
  const std::string_view name = kernel_name(kernel);
  return std::find_if(std::begin(stored_kernels), std::end(stored_kernels),
                      [&](const StoredKernel& each) { return kernel_name(each.kernel) == name; })
      ->name;
}

}  // namespace

bool needs_splat_version(const Splats& splats) {
  return !std::holds_alternative<TriangleWindows>(splats.kernel) || splats.color.per_corner ||
         splats.profile != *profile_named("triangle-splatting");
}

json profile_json(const SplatProfile& profile) {
  return {{"projection", layout::splat_projections[int(profile.projection)]},
          {"low_pass", layout::splat_low_passes[int(profile.low_pass)]},
          {"max_alpha", profile.max_alpha},
          {"min_alpha", profile.min_alpha},
          {"stop_transmittance", profile.stop_transmittance},
          {"min_center_depth", profile.min_center_depth}};
}

json add_splats(BinaryPlan& plan, json& extension, const Splats& splats) {
  require_sound(splats);
  extension["splat_count"] = count(splats);
  json ours = {{"kernel", stored_kernel(splats.kernel)},
               {"degree", splats.color.degree},
               {"profile", profile_json(splats.profile)}};
  json attributes = json::object();
  add_columns(plan, attributes, ours, splats.kernel);
  if (count(splats) == 0) {
    extension["splats"] = std::move(ours);  // there is no primitive: glTF has no empty mesh
    return nullptr;
  }
  plan.owned_accessor(attributes, "COLOR_0", point_colors(splats), vec4_unorm16);
  add_coefficients(plan, attributes, splats.color);
  const bool is_ellipse = std::holds_alternative<Gaussians>(splats.kernel);
  json splatting = {{"kernel", is_ellipse ? "ellipse" : stored_kernel(splats.kernel)},
                    {"colorSpace", "srgb_rec709_display"},
                    {"projection", "perspective"},
                    {"sortingMethod", "cameraDistance"},
                    {"extensions", {{layout::splats_extension, std::move(ours)}}}};
  return {{"attributes", std::move(attributes)},
          {"material", 0},
          {"mode", 0},
          {"extensions", {{layout::splatting_extension, std::move(splatting)}}}};
}

}  // namespace glb_writing

}  // namespace tureen
