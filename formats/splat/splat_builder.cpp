#include "formats/splat/splat_builder.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>

#include "scene/edit/morton_order.hpp"
#include "scene/edit/splat_limit.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen {

namespace {

bool is_valid_density(const glm::vec3& semi_axes, std::span<const float> network) {
  return semi_axes.x > 0 && semi_axes.y > 0 && semi_axes.z > 0 &&
         std::all_of(network.begin(), network.end(), [](float v) { return std::isfinite(v); });
}

}  // namespace

SplatBuilder::SplatBuilder(Input& input, const ReadOptions& options, Kind kind, int degree,
                           std::uint64_t count)
    : input_(input), kind_(kind), max_splats_(options.max_splats) {
  if (count > std::numeric_limits<std::uint32_t>::max())
    input.fail(std::to_string(count) + " splats are more than 32 bits can count");
  const bool is_neural = kind == Kind::neural_densities;
  if (is_neural)
    splats_.kernel.emplace<NeuralDensities>();
  else
    splats_.kernel.emplace<Gaussians>().flat = kind == Kind::flat_gaussians;
  if (options.found_splats)
    options.found_splats(count, count * bytes_per_splat(splats_.kernel, degree));
  const std::uint64_t held = max_splats_ ? std::min(count, 2 * *max_splats_) : count;
  require_memory(held, bytes_per_splat(splats_.kernel, degree), count);
  const auto reserve = [&](auto& values, std::size_t each) {
    input_.take_memory(held, each * sizeof(values[0]), "the splats");
    values.reserve(static_cast<std::size_t>(held) * each);
  };
  splats_.color.degree = degree;
  reserve(splats_.color.coefficients, std::size_t(harmonics::count(degree)));
  if (is_neural) {
    auto& densities = std::get<NeuralDensities>(splats_.kernel);
    reserve(densities.centers, 1);
    reserve(densities.semi_axes, 1);
    reserve(densities.rotations, 1);
    reserve(densities.networks, NeuralDensities::parameters);
  } else {
    auto& gaussians = std::get<Gaussians>(splats_.kernel);
    reserve(gaussians.centers, 1);
    reserve(gaussians.scales, 1);
    reserve(gaussians.rotations, 1);
    reserve(gaussians.opacity, 1);
  }
}

void SplatBuilder::require_memory(std::uint64_t held, std::size_t each, std::uint64_t all) const {
  const std::uint64_t fitting = input_.budget().left() / each;
  if (held <= fitting) return;
  // With --max-splats, twice as many are held, and to sort them takes as much as one time.
  input_.fail(input_.budget().refusal(std::to_string(all) + " splats of " + std::to_string(each) +
                                      " bytes each"),
              std::string(max_memory_hint) + ", or read fewer: --max-splats " +
                  std::to_string(std::max<std::uint64_t>(fitting / 3, 1)));
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
  if (max_splats_ && count(splats_) >= 2 * *max_splats_)
    splats_ = largest_splats(std::move(splats_), static_cast<std::size_t>(*max_splats_));
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
  if (max_splats_)
    splats_ = largest_splats(std::move(splats_), static_cast<std::size_t>(*max_splats_));
  {
    PassingMemory passing(input_.budget());
    input_.take_memory(morton_order_bytes(splats_), 1, "the order of the splats");
    sort_in_morton_order(splats_);
  }
  const std::uint64_t kept = count(splats_), valid = added_ - dropped_;
  Scene scene = scene_of(std::move(splats_));
  scene.info.name = std::filesystem::path(input_.name()).stem().string();
  scene.info.source = format;
  scene.info.up = splat_up;
  scene.info.up_is_assumed = true;
  scene.info.remarks.push_back({.kind = Remark::Kind::up_unknown_to_splats, .names = {format}});
  if (dropped_ > 0)
    scene.info.remarks.push_back({Remark::Kind::splats_dropped, {dropped_, added_}});
  if (kept < valid) scene.info.remarks.push_back({Remark::Kind::splats_limited, {kept, valid}});
  return scene;
}

}  // namespace tureen
