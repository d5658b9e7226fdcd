#include "formats/splat/splat_builder.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>

#include "scene/edit/morton_order.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen {

namespace {

bool is_valid_density(const glm::vec3& semi_axes, std::span<const float> network) {
  return semi_axes.x > 0 && semi_axes.y > 0 && semi_axes.z > 0 &&
         std::all_of(network.begin(), network.end(), [](float v) { return std::isfinite(v); });
}

}  // namespace

SplatBuilder::SplatBuilder(Input& input, Kind kind, int degree, std::uint64_t count)
    : input_(input), kind_(kind) {
  if (count > std::numeric_limits<std::uint32_t>::max())
    input.fail(std::to_string(count) + " splats are more than 32 bits can count");
  const auto splats = static_cast<std::size_t>(count);
  const auto reserve = [&](auto& values, std::size_t each) {
    input_.take_memory(count, each * sizeof(values[0]), "the splats");
    values.reserve(splats * each);
  };
  splats_.color.degree = degree;
  reserve(splats_.color.coefficients, std::size_t(harmonics::count(degree)));
  if (kind == Kind::neural_densities) {
    auto& densities = splats_.kernel.emplace<NeuralDensities>();
    reserve(densities.centers, 1);
    reserve(densities.semi_axes, 1);
    reserve(densities.rotations, 1);
    reserve(densities.networks, NeuralDensities::parameters);
  } else {
    auto& gaussians = splats_.kernel.emplace<Gaussians>();
    gaussians.flat = kind == Kind::flat_gaussians;
    reserve(gaussians.centers, 1);
    reserve(gaussians.scales, 1);
    reserve(gaussians.rotations, 1);
    reserve(gaussians.opacity, 1);
  }
}

void SplatBuilder::add(const SplatValues& splat, std::span<const glm::vec3> coefficients,
                       std::span<const float> network) {
  assert(coefficients.size() == std::size_t(harmonics::count(splats_.color.degree)));
  ++added_;
  const std::optional<glm::quat> rotation = unit_rotation(splat.rotation);
  const bool is_neural = kind_ == Kind::neural_densities;
  if (!rotation || !is_valid_splat(splat, coefficients) ||
      (is_neural && !is_valid_density(glm::vec3(splat.scales), network))) {
    ++dropped_;
    return;
  }
  auto& colors = splats_.color.coefficients;
  colors.insert(colors.end(), coefficients.begin(), coefficients.end());
  if (is_neural) {
    auto& densities = std::get<NeuralDensities>(splats_.kernel);
    densities.centers.emplace_back(splat.center);
    densities.semi_axes.emplace_back(splat.scales);
    densities.rotations.push_back(*rotation);
    densities.networks.insert(densities.networks.end(), network.begin(), network.end());
    return;
  }
  auto& gaussians = std::get<Gaussians>(splats_.kernel);
  gaussians.centers.emplace_back(splat.center);
  gaussians.scales.emplace_back(splat.scales);
  gaussians.rotations.push_back(*rotation);
  gaussians.opacity.push_back(static_cast<float>(splat.opacity));
}

Scene SplatBuilder::finish(const SplatProfile& profile, const std::string& format) {
  splats_.profile = profile;
  {
    PassingMemory passing(input_.budget());
    input_.take_memory(morton_order_bytes(splats_), 1, "the order of the splats");
    sort_in_morton_order(splats_);
  }
  Scene scene = scene_of(std::move(splats_));
  scene.info.name = std::filesystem::path(input_.name()).stem().string();
  scene.info.source = format;
  scene.info.up = splat_up;
  scene.info.up_is_assumed = true;
  scene.info.remarks.push_back({.kind = Remark::Kind::up_unknown_to_splats, .names = {format}});
  if (dropped_ > 0)
    scene.info.remarks.push_back({Remark::Kind::splats_dropped, {dropped_, added_}});
  return scene;
}

}  // namespace tureen
