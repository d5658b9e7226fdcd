#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <iterator>
#include <optional>
#include <span>

#include "base/output.hpp"
#include "formats/common/splat_activation.hpp"
#include "formats/ply/ply_bytes.hpp"
#include "formats/splat/splat_ply.hpp"
#include "formats/splat/splat_ply_layout.hpp"
#include "scene/edit/baked_transform.hpp"
#include "scene/edit/moved_splats.hpp"

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
    const int degree = std::max(gaussians ? 0 : 3, splats_.color.degree);
    const std::vector<SplatPlyProperty> properties =
        splat_ply_properties(splats_.kernel, gaussians && gaussians->flat ? 2 : 3, degree);
    std::string text = "ply\nformat binary_little_endian 1.0\n" + marks_.comments +
                       "element vertex " + std::to_string(count(splats_)) + "\n";
    for (const SplatPlyProperty& each : properties) text += "property float " + each.name + "\n";
    output_.write(std::string_view(text + "end_header\n"));
    for (std::size_t i = 0; i < count(splats_); ++i) {
      fill_row(i);
      for (const SplatPlyProperty& each : properties)
        bytes_.real(each.slot == splat_slot::none ? 0.0f : row_[std::size_t(each.slot)]);
    }
    bytes_.flush();
  }

 private:
  /// Sets the slots of splat `i`; coefficients beyond its degree stay 0.
  void fill_row(std::size_t i) {
    namespace slot = splat_slot;
    for_each_column(splats_.kernel, [&](const auto& column) {
      const std::span<const float> values = column.of_splat(i);
      if (column.role == ColumnRole::position)
        std::copy(values.begin(), values.end(), &row_[slot::center]);
      else if (column.role == ColumnRole::scale)
        std::transform(values.begin(), values.end(), &row_[slot::scale], stored_scale);
      else if (column.role == ColumnRole::opacity)
        row_[slot::opacity] = stored_opacity(double(values[0]));
      else if (column.role == ColumnRole::value)
        std::copy(values.begin(), values.end(), &row_[slot::network]);
      else if (column.role == ColumnRole::rotation) {
        glm::dquat rotation(values[3], values[0], values[1], values[2]);
        // The inverse of the reader's exchange of axes.
        if (marks_.normal_first) rotation = rotation * glm::dquat(0.5, -0.5, -0.5, -0.5);
        const double wxyz[] = {rotation.w, rotation.x, rotation.y, rotation.z};
        std::copy(std::begin(wxyz), std::end(wxyz), &row_[slot::rotation]);
      }
    });
    const std::size_t each = coefficients_per_splat(splats_.color);
    const glm::vec3* coefficients = &splats_.color.coefficients[i * each];
    std::copy_n(&coefficients[0].x, 3 * each, &row_[slot::color]);
  }

  Output& output_;
  PlyBytes bytes_;
  const Splats& splats_;
  SplatPlyMarks marks_;
  std::array<float, splat_slot::count> row_{};
};

}  // namespace

bool fits_splat_ply(const Scene& scene) {
  if (scene.layers.size() != 1) return false;
  const auto* splats = std::get_if<Splats>(&scene.layers[0].primitives);
  return splats && (std::holds_alternative<Gaussians>(splats->kernel) ||
                    std::holds_alternative<NeuralDensities>(splats->kernel));
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
