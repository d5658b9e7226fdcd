#include <algorithm>
#include <cmath>
#include <cstddef>

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

namespace glb_writing {

namespace {

constexpr BinaryPlan::Format splat_scalar{"SCALAR", layout::float32, 1};
constexpr BinaryPlan::Format splat_vec3{"VEC3", layout::float32, 3};
constexpr BinaryPlan::Format splat_vec4{"VEC4", layout::float32, 4};
constexpr BinaryPlan::Format splat_color{"VEC4", layout::unsigned_short, 4, true};

// glTF stores x, y, z, w.
static_assert(offsetof(glm::quat, x) == 0 && offsetof(glm::quat, w) == 3 * sizeof(float));

std::string attribute(const char* name) {
  return std::string(layout::splatting_extension) + ":" + name;
}

/// The arrays of a primitive of points.
struct AddSplatArrays {
  BinaryPlan& plan;
  json& attributes;
  json& ours;  // TUREEN_splats

  void operator()(const Gaussians& gaussians) const {
    add_ellipsoids(gaussians.centers, gaussians.scales, gaussians.rotations);
    plan.accessor(attributes, attribute("OPACITY").c_str(), bytes_of(gaussians.opacity),
                  splat_scalar);
  }

  void operator()(const NeuralDensities& densities) const {
    add_ellipsoids(densities.centers, densities.semi_axes, densities.rotations);
    plan.owned_accessor(attributes, attribute("OPACITY").c_str(), mean_opacity(densities),
                        splat_scalar);
    plan.accessor(ours, "networks", bytes_of(densities.networks), splat_scalar);
    ours["omega"] = densities.omega;
  }

  void operator()(const TriangleWindows&) const {}

  void add_ellipsoids(const std::vector<glm::vec3>& centers, const std::vector<glm::vec3>& scales,
                      const std::vector<glm::quat>& rotations) const {
    plan.accessor(attributes, "POSITION", bytes_of(centers), splat_vec3);
    if (!centers.empty())
      add_range(plan.accessors[attributes["POSITION"].get<std::size_t>()], centers);
    plan.accessor(attributes, attribute("SCALE").c_str(), bytes_of(scales), splat_vec3);
    plan.accessor(attributes, attribute("ROTATION").c_str(), bytes_of(rotations), splat_vec4);
  }

  /// KHR_gaussian_splatting requires an opacity. Viewers without our kernel use that of a sphere
  /// with the constant part of the density, along its diameter of 2.
  static std::vector<float> mean_opacity(const NeuralDensities& densities) {
    std::vector<float> opacity(densities.centers.size());
    for (std::size_t i = 0; i < opacity.size(); ++i) {
      const float constant =
          densities.networks[NeuralDensities::parameters * i + NeuralDensities::parameters - 1];
      opacity[i] = static_cast<float>(1.0 - std::exp(-2.0 * std::max(double(constant), 0.0)));
    }
    return opacity;
  }
};

/// The colours for other viewers: the constant part of the harmonics, and the opacity.
std::vector<glm::u16vec4> point_colors(const Splats& splats) {
  const auto* gaussians = std::get_if<Gaussians>(&splats.kernel);
  const std::size_t stride = harmonics::count(splats.color.degree);
  std::vector<glm::u16vec4> colors(count(splats));
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const glm::vec3 constant = 0.5f + float(harmonics::y00) * splats.color.coefficients[stride * i];
    colors[i] = linear_unorm16(glm::clamp(constant, 0.0f, 1.0f),
                               gaussians ? double(gaussians->opacity[i]) : 1.0);
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
                          splat_vec3);
    }
}

const char* stored_kernel(const SplatKernel& kernel) {
  const auto* gaussians = std::get_if<Gaussians>(&kernel);
  return layout::splat_kernels[!gaussians ? 2 : gaussians->flat ? 1 : 0];
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
  if (const auto reason = defect(splats))
    throw UsageError("the scene cannot be written: " + *reason);
  extension["splat_count"] = count(splats);
  json ours = {{"kernel", stored_kernel(splats.kernel)},
               {"degree", splats.color.degree},
               {"profile", profile_json(splats.profile)}};
  json attributes = json::object();
  std::visit(AddSplatArrays{plan, attributes, ours}, splats.kernel);
  if (count(splats) == 0) {
    extension["splats"] = std::move(ours);  // there is no primitive: glTF has no empty mesh
    return nullptr;
  }
  plan.owned_accessor(attributes, "COLOR_0", point_colors(splats), splat_color);
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
