#include "formats/splat/splat_builder.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>

#include "formats/common/format_remarks.hpp"
#include "formats/splat/splat_remarks.hpp"
#include "scene/edit/morton_order.hpp"
#include "scene/edit/splat_limit.hpp"
#include "scene/scene_remarks.hpp"
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
    : input_(input), kind_(kind) {
  if (count > std::numeric_limits<std::uint32_t>::max())
    input.fail(std::to_string(count) + " splats are more than 32 bits can count");
  const bool is_neural = kind == Kind::neural_densities;
  if (is_neural)
    splats_.kernel.emplace<NeuralDensities>();
  else
    splats_.kernel.emplace<Gaussians>().flat = kind == Kind::flat_gaussians;
  if (options.found_splats)
    options.found_splats(count, count * bytes_per_splat(splats_.kernel, degree));
  const std::uint64_t kept = std::min(count, options.max_splats.value_or(count));
  const std::uint64_t held = std::min(count, kept + kept / 8 + 1);
  kept_ = static_cast<std::size_t>(kept);
  held_ = static_cast<std::size_t>(held);
  const std::size_t bytes = bytes_per_splat(splats_.kernel, degree);
  // An eighth more, and their order: at most the bytes again, a key, and what largest_splats()
  // needs.
  fitting_ = input.budget().left() / (2 * bytes + bytes / 8 + 1 + 16 + 2 * limit_bytes_per_splat);
  take(held * bytes, std::to_string(count) + " splats of " + std::to_string(bytes) + " bytes each");
  const auto reserve = [&](auto& values, std::size_t each) { values.reserve(held_ * each); };
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

void SplatBuilder::take(std::uint64_t bytes, const std::string& what) {
  MemoryBudget budget = input_.budget();
  if (budget.take(bytes)) return;
  std::string hint = max_memory_hint;
  if (fitting_ > 0) hint += ", or read fewer: --max-splats " + std::to_string(fitting_);
  input_.fail(budget.refusal(what), hint);
}

void SplatBuilder::keep_largest() {
  PassingMemory passing(input_.budget());
  take(limit_bytes_per_splat * count(splats_), "the order of the splats");
  splats_ = largest_splats(std::move(splats_), kept_);
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
  if (kept_ < held_ && count(splats_) == held_) keep_largest();
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
  if (count(splats_) > kept_) keep_largest();
  {
    PassingMemory passing(input_.budget());
    take(morton_order_bytes(splats_), "the order of the splats");
    sort_in_morton_order(splats_);
  }
  const std::uint64_t kept = count(splats_), valid = added_ - dropped_;
  Scene scene = scene_of(std::move(splats_));
  scene.info.name = std::filesystem::path(input_.name()).stem().string();
  scene.info.source = format;
  scene.info.up = splat_up;
  scene.info.up_is_assumed = true;
  scene.info.remarks.push_back({&remarks::up_unknown_to_splats, {{"format", format}}});
  if (dropped_ > 0)
    scene.info.remarks.push_back(
        {&remarks::splats_dropped, {{"dropped", dropped_}, {"all", added_}}});
  if (kept < valid)
    scene.info.remarks.push_back({&remarks::splats_limited, {{"kept", kept}, {"all", valid}}});
  return scene;
}

}  // namespace tureen
