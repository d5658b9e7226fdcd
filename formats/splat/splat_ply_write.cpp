#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <span>

#include "base/output.hpp"
#include "formats/common/splat_activation.hpp"
#include "formats/ply/ply_bytes.hpp"
#include "formats/splat/splat_ply.hpp"
#include "formats/splat/splat_ply_layout.hpp"
#include "formats/splat/splat_writing.hpp"

namespace tureen {

namespace {

/// How a file marks the profile, and the name of the profile that readers find.
struct SplatPlyMarks {
  const char* comments;
  bool normal_first;
  const char* profile;
};

SplatPlyMarks marks_of(const Splats& splats) {
  using Profile = SplatProfile;
  const auto* gaussians = std::get_if<Gaussians>(&splats.kernel);
  if (!gaussians) return {"", false, "splatnet"};
  const Profile& profile = splats.profile;
  if (profile.projection == Profile::Projection::plane) {
    if (profile.low_pass == Profile::LowPass::screen)
      return {"comment SplatRenderMode: 2dgs\n", false, "2dgs"};
    return {"comment SplatRenderMode: default\ncomment TureenSplatProfile: redisplats\n", true,
            "redisplats"};
  }
  if (profile.low_pass == Profile::LowPass::mip)
    return {"comment SplatRenderMode: mip\n", gaussians->flat, "mip"};
  return {"comment SplatRenderMode: default\n", gaussians->flat, "3dgs"};
}

std::vector<std::string> splat_ply_losses(const Scene& scene, const Layer& layer,
                                          const Splats& splats) {
  std::vector<std::string> lost = splat_losses(scene, layer, "PLY", marks_of(splats).profile);
  const auto* densities = std::get_if<NeuralDensities>(&splats.kernel);
  if (densities && densities->omega != NeuralDensities{}.omega)
    lost.push_back("PLY holds no omega; readers use 30.");
  return lost;
}

/// Sets the slots of splat `i`; coefficients beyond its degree stay as they are.
void fill_row(const Splats& splats, std::size_t i, bool normal_first,
              std::array<float, splat_slot::count>& row) {
  namespace slot = splat_slot;
  for_each_column(splats.kernel, [&](const auto& column) {
    const std::span<const float> values = column.of_splat(i);
    const auto put = [&](int first) { std::copy(values.begin(), values.end(), &row[first]); };
    if (column.role == ColumnRole::position) put(slot::center);
    if (column.role == ColumnRole::value) put(slot::network);
    if (column.role == ColumnRole::opacity) row[slot::opacity] = stored_opacity(double(values[0]));
    if (column.role == ColumnRole::scale)
      std::transform(values.begin(), values.end(), &row[slot::scale], stored_scale);
    if (column.role != ColumnRole::rotation) return;
    glm::dquat rotation(values[3], values[0], values[1], values[2]);
    // The inverse of the reader's exchange of axes.
    if (normal_first) rotation = rotation * glm::dquat(0.5, -0.5, -0.5, -0.5);
    const double wxyz[] = {rotation.w, rotation.x, rotation.y, rotation.z};
    std::copy(std::begin(wxyz), std::end(wxyz), &row[slot::rotation]);
  });
  const std::size_t each = coefficients_per_splat(splats.color);
  std::copy_n(&splats.color.coefficients[i * each].x, 3 * each, &row[slot::color]);
}

void write_vertices(const Splats& splats, Output& output) {
  const SplatPlyMarks marks = marks_of(splats);
  const auto* gaussians = std::get_if<Gaussians>(&splats.kernel);
  // The authors' reader of neural primitives expects degree 3.
  const std::vector<SplatPlyProperty> properties =
      splat_ply_properties(splats.kernel, gaussians && gaussians->flat ? 2 : 3,
                           std::max(gaussians ? 0 : 3, splats.color.degree));
  std::string text = std::string("ply\nformat binary_little_endian 1.0\n") + marks.comments +
                     "element vertex " + std::to_string(count(splats)) + "\n";
  for (const SplatPlyProperty& each : properties) text += "property float " + each.name + "\n";
  output.write(std::string_view(text + "end_header\n"));
  PlyBytes bytes(output);
  std::array<float, splat_slot::count> row{};
  for (std::size_t i = 0; i < count(splats); ++i) {
    fill_row(splats, i, marks.normal_first, row);
    for (const SplatPlyProperty& each : properties)
      bytes.real(each.slot == splat_slot::none ? 0.0f : row[std::size_t(each.slot)]);
  }
  bytes.flush();
}

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
  write_vertices(splats, output);
  output.commit();
  return splat_ply_losses(scene, *layer, splats);
}

}  // namespace tureen
