#include <algorithm>
#include <glm/geometric.hpp>
#include <optional>

#include "base/output.hpp"
#include "formats/common/splat_activation.hpp"
#include "formats/ply/ply_bytes.hpp"
#include "formats/splat/splat_builder.hpp"
#include "formats/splat/splat_ply.hpp"
#include "scene/edit/baked_transform.hpp"
#include "scene/edit/moved_splats.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen {

namespace {

/// How a file marks the profile.
struct SplatPlyMarks {
  std::string comments;
  bool normal_first = false;
};

SplatPlyMarks marks_of(const Splats& splats) {
  using Profile = SplatProfile;
  const auto* gaussians = std::get_if<Gaussians>(&splats.kernel);
  if (!gaussians) return {};
  const Profile& profile = splats.profile;
  if (profile.projection == Profile::Projection::ewa)
    return {profile.low_pass == Profile::LowPass::mip ? "comment SplatRenderMode: mip\n"
                                                      : "comment SplatRenderMode: default\n",
            gaussians->flat};
  if (profile.low_pass == Profile::LowPass::screen)
    return {"comment SplatRenderMode: 2dgs\n", false};
  return {"comment SplatRenderMode: default\ncomment TureenSplatProfile: redisplats\n", true};
}

/// The profile that the reader finds.
SplatProfile stored_profile(const Splats& splats) {
  using Profile = SplatProfile;
  if (!std::holds_alternative<Gaussians>(splats.kernel)) return *profile_named("splatnet");
  if (splats.profile.projection == Profile::Projection::ewa)
    return *profile_named(splats.profile.low_pass == Profile::LowPass::mip ? "mip" : "3dgs");
  return *profile_named(splats.profile.low_pass == Profile::LowPass::screen ? "2dgs"
                                                                            : "redisplats");
}

/// Moves the splats into world coordinates; relative to the layer's origin if that is so far away
/// that positions would lose more than 7 of their 24 bits.
void place_in_world(Layer& layer) {
  constexpr double farthest = 128;  // in radii of the layer
  bake_transform(layer);
  const Bounds box = bounds(layer);
  if (glm::length(origin_of(layer)) > farthest * box.radius()) return;
  move_splats(std::get<Splats>(layer.primitives), layer.world_from_layer);
  layer.world_from_layer = glm::dmat4(1.0);
}

std::vector<std::string> splat_ply_losses(const Scene& scene, const Layer& layer,
                                          const Splats& splats) {
  std::vector<std::string> lost;
  if (!(splats.profile == stored_profile(splats)))
    lost.push_back("PLY cannot hold this profile; readers use " +
                   std::string(name_of(stored_profile(splats))) + ".");
  const auto* densities = std::get_if<NeuralDensities>(&splats.kernel);
  if (densities && densities->omega != NeuralDensities{}.omega)
    lost.push_back("PLY holds no omega; readers use 30.");
  if (layer.world_from_layer != glm::dmat4(1.0))
    lost.push_back("PLY holds no origin: the splats are written relative to it.");
  if (scene.info.up != splat_up)
    lost.push_back("PLY stores no up axis; readers assume (0, -1, 0).");
  if (scene.info.background != glm::vec3(0.0f)) lost.push_back("PLY holds no background colour.");
  if (!scene.cameras.empty()) lost.push_back("PLY holds no cameras.");
  return lost;
}

class SplatPlyWriter {
 public:
  SplatPlyWriter(Output& output, const Splats& splats)
      : output_(output), bytes_(output), splats_(splats), marks_(marks_of(splats)) {}

  void write() {
    const auto* gaussians = std::get_if<Gaussians>(&splats_.kernel);
    // The authors' reader of neural primitives expects degree 3.
    const int least = gaussians ? 0 : 3;
    rest_ = std::size_t(harmonics::count(std::max(least, splats_.color.degree))) - 1;
    write_header(gaussians);
    for (std::size_t i = 0; i < count(splats_); ++i) {
      if (gaussians)
        write_gaussian(*gaussians, i);
      else
        write_density(std::get<NeuralDensities>(splats_.kernel), i);
    }
    bytes_.flush();
  }

 private:
  void write_header(const Gaussians* gaussians) {
    std::string text = "ply\nformat binary_little_endian 1.0\n" + marks_.comments +
                       "element vertex " + std::to_string(count(splats_)) + "\n";
    const auto name = [&](const std::string& property) {
      text += "property float " + property + "\n";
    };
    const auto names = [&](const char* prefix, std::size_t number) {
      for (std::size_t i = 0; i < number; ++i) name(prefix + std::to_string(i));
    };
    for (const char* property : {"x", "y", "z", "nx", "ny", "nz"}) name(property);
    names("f_dc_", 3);
    names("f_rest_", 3 * rest_);
    name("opacity");
    if (!gaussians) name("opacity_volr");
    names("scale_", gaussians && gaussians->flat ? 2 : 3);
    names("rot_", 4);
    if (!gaussians) {
      names("frequencies_", 3 * NeuralDensities::width);
      names("phases_", NeuralDensities::width);
      names("amplitudes_", NeuralDensities::width);
      name("offsets");
    }
    output_.write(std::string_view(text + "end_header\n"));
  }

  void write_vector(const glm::vec3& v) {
    for (int k = 0; k < 3; ++k) bytes_.real(v[k]);
  }

  /// The centre, a normal of zeros as the authors write it, and the colour.
  void write_start(const glm::vec3& center, std::size_t i) {
    write_vector(center);
    write_vector(glm::vec3(0.0f));
    const auto own = std::size_t(harmonics::count(splats_.color.degree));
    const glm::vec3* coefficients = &splats_.color.coefficients[i * own];
    write_vector(coefficients[0]);
    for (int channel = 0; channel < 3; ++channel)
      for (std::size_t k = 1; k <= rest_; ++k)
        bytes_.real(k < own ? coefficients[k][channel] : 0.0f);
  }

  void write_rotation(const glm::quat& q) {
    for (const float part : {q.w, q.x, q.y, q.z}) bytes_.real(part);
  }

  void write_gaussian(const Gaussians& gaussians, std::size_t i) {
    write_start(gaussians.centers[i], i);
    bytes_.real(stored_opacity(double(gaussians.opacity[i])));
    for (int k = 0; k < (gaussians.flat ? 2 : 3); ++k)
      bytes_.real(stored_scale(double(gaussians.scales[i][k])));
    glm::dquat rotation(gaussians.rotations[i]);
    // The inverse of the reader's exchange of axes.
    if (marks_.normal_first) rotation = rotation * glm::dquat(0.5, -0.5, -0.5, -0.5);
    write_rotation(glm::quat(rotation));
  }

  void write_density(const NeuralDensities& densities, std::size_t i) {
    write_start(densities.centers[i], i);
    bytes_.real(0.0f);  // opacity and opacity_volr, which the method does not use
    bytes_.real(0.0f);
    for (int k = 0; k < 3; ++k) bytes_.real(stored_scale(double(densities.semi_axes[i][k])));
    write_rotation(densities.rotations[i]);
    constexpr std::size_t width = NeuralDensities::width;
    const float* network = &densities.networks[i * NeuralDensities::parameters];
    for (std::size_t dimension = 0; dimension < 3; ++dimension)
      for (std::size_t neuron = 0; neuron < width; ++neuron)
        bytes_.real(network[3 * neuron + dimension]);
    for (std::size_t k = 3 * width; k < NeuralDensities::parameters; ++k) bytes_.real(network[k]);
  }

  Output& output_;
  PlyBytes bytes_;
  const Splats& splats_;
  SplatPlyMarks marks_;
  std::size_t rest_ = 0;  // coefficients a channel beyond degree 0
};

}  // namespace

bool fits_splat_ply(const Scene& scene) {
  if (scene.layers.size() != 1) return false;
  const auto* splats = std::get_if<Splats>(&scene.layers[0].primitives);
  return splats && !std::holds_alternative<TriangleWindows>(splats->kernel);
}

std::vector<std::string> write_splat_ply(const Scene& scene, const std::filesystem::path& path) {
  std::optional<Layer> placed;
  const Layer* layer = &only_layer(scene);
  if (layer->world_from_layer != glm::dmat4(1.0)) {
    placed = *layer;
    place_in_world(*placed);
    layer = &*placed;
  }
  const auto& splats = std::get<Splats>(layer->primitives);
  Output output(path);
  SplatPlyWriter(output, splats).write();
  output.commit();
  return splat_ply_losses(scene, *layer, splats);
}

}  // namespace tureen
