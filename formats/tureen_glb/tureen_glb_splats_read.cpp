#include "formats/gltf/glb_arrays.hpp"
#include "formats/tureen_glb/tureen_glb.hpp"
#include "formats/tureen_glb/tureen_glb_splats.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen {

namespace {

namespace splat_layout = glb_layout;

/// The JSON of a layer's splats.
struct SplatLayout {
  std::uint64_t splats = 0;
  JsonView ours;        // TUREEN_splats
  JsonView attributes;  // of the primitive; without splats not used
};

SplatLayout splat_layout_of(const GlbArrays& arrays, const JsonView& node,
                            const JsonView& splat_count) {
  const std::uint64_t splats = splat_count.natural(GlbArrays::max_count);
  if (splats == 0) {
    const JsonView ours = node["extensions"][tureen_extension]["splats"];
    return {splats, ours, ours};
  }
  const JsonView primitive =
      arrays.root()["meshes"].at(GlbArrays::index(node["mesh"]))["primitives"].at(0);
  return {splats,
          primitive["extensions"][splat_layout::splatting_extension]["extensions"]
                   [splat_layout::splats_extension],
          primitive["attributes"]};
}

class SplatReader {
 public:
  SplatReader(GlbArrays& arrays, SplatLayout layout)
      : arrays_(arrays), layout_(std::move(layout)) {}

  Splats splats() {
    Splats splats;
    splats.profile = read_splat_profile(layout_.ours["profile"]);
    splats.kernel = kernel();
    splats.color.degree = int(layout_.ours["degree"].natural(harmonics::max_degree));
    splats.color.coefficients = coefficients(splats.color.degree);
    if (const auto reason = defect(splats)) layout_.ours.fail(*reason);
    return splats;
  }

 private:
  SplatKernel kernel() {
    const std::size_t kernel = layout_.ours["kernel"].one_of(splat_layout::splat_kernels);
    if (kernel < 2) {
      Gaussians gaussians;
      gaussians.flat = kernel == 1;
      read_ellipsoids(gaussians.centers, gaussians.scales, gaussians.rotations);
      gaussians.opacity = attribute<float>("OPACITY", glb_formats::scalar_float);
      return gaussians;
    }
    NeuralDensities densities;
    read_ellipsoids(densities.centers, densities.semi_axes, densities.rotations);
    densities.networks =
        arrays_.read<float>(layout_.ours, "networks", NeuralDensities::parameters * layout_.splats,
                            glb_formats::scalar_float);
    densities.omega = layout_.ours["omega"].number_float();
    return densities;
  }

  void read_ellipsoids(std::vector<glm::vec3>& centers, std::vector<glm::vec3>& scales,
                       std::vector<glm::quat>& rotations) {
    if (layout_.splats == 0) return;
    centers = arrays_.read<glm::vec3>(layout_.attributes, "POSITION", layout_.splats,
                                      glb_formats::vec3_float);
    scales = attribute<glm::vec3>("SCALE", glb_formats::vec3_float);
    rotations = attribute<glm::quat>("ROTATION", glb_formats::vec4_float);
  }

  template <class T>
  std::vector<T> attribute(const char* name, const GlbArrays::Format& format) {
    if (layout_.splats == 0) return {};
    const std::string key = std::string(splat_layout::splatting_extension) + ":" + name;
    return arrays_.read<T>(layout_.attributes, key.c_str(), layout_.splats, format);
  }

  std::vector<glm::vec3> coefficients(int degree) {
    if (layout_.splats == 0) return {};
    // Every array is located first: a false count fails before the memory is taken.
    std::vector<GlbArrays::Location> planes;
    for (int l = 0; l <= degree; ++l)
      for (int order = 0; order < 2 * l + 1; ++order)
        planes.push_back(arrays_.location(layout_.attributes, harmonics_attribute(l, order).c_str(),
                                          layout_.splats, glb_formats::vec3_float));
    arrays_.take_memory(layout_.splats * planes.size(), sizeof(glm::vec3), "harmonics");
    std::vector<glm::vec3> result(static_cast<std::size_t>(layout_.splats) * planes.size());
    for (std::size_t k = 0; k < planes.size(); ++k) {
      PassingMemory passing(arrays_.budget());
      const auto plane = arrays_.read_at<glm::vec3>(planes[k], "harmonics");
      for (std::size_t i = 0; i < plane.size(); ++i) result[i * planes.size() + k] = plane[i];
    }
    return result;
  }

  GlbArrays& arrays_;
  SplatLayout layout_;
};

}  // namespace

SplatProfile read_splat_profile(const JsonView& view) {
  SplatProfile profile;
  profile.projection =
      SplatProfile::Projection(view["projection"].one_of(splat_layout::splat_projections));
  profile.low_pass = SplatProfile::LowPass(view["low_pass"].one_of(splat_layout::splat_low_passes));
  profile.max_alpha = view["max_alpha"].number_float();
  profile.min_alpha = view["min_alpha"].number_float();
  profile.stop_transmittance = view["stop_transmittance"].number_float();
  if (const auto depth = view.find("min_center_depth"))
    profile.min_center_depth = depth->number_float();
  return profile;
}

Splats read_splats(GlbArrays& arrays, const JsonView& node, const JsonView& splat_count) {
  return SplatReader(arrays, splat_layout_of(arrays, node, splat_count)).splats();
}

}  // namespace tureen
