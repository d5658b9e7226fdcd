#include "formats/splat/splat_builder.hpp"

#include <algorithm>
#include <cassert>
#include <filesystem>
#include <limits>
#include <type_traits>
#include <utility>

#include "formats/common/format_remarks.hpp"
#include "formats/splat/splat_remarks.hpp"
#include "scene/edit/morton_order.hpp"
#include "scene/edit/splat_limit.hpp"
#include "scene/middle_bounds.hpp"
#include "scene/near_limit.hpp"
#include "scene/scene_remarks.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen {

SplatBuilder::SplatBuilder(Input& input, const ReadOptions& options, SplatKernel kernel, int degree,
                           std::uint64_t count)
    : input_(input), keep_rows_(options.keep_rows), splats_{.kernel = std::move(kernel)} {
  if (count > std::numeric_limits<std::uint32_t>::max())
    input.fail(std::to_string(count) + " splats are more than 32 bits can count");
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
  if (keep_rows_) {
    take(held * sizeof splats_.rows[0], "the rows of the splats");
    splats_.rows.reserve(held_);
  }
  splats_.color.degree = degree;
  for_each_array(splats_, [&](auto& values, std::size_t each) { values.reserve(held_ * each); });
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
                       std::span<const float> values) {
  assert(coefficients.size() == std::size_t(harmonics::count(splats_.color.degree)));
  const std::uint64_t row = added_++;
  const std::optional<glm::quat> rotation = unit_rotation(splat.rotation);
  if (!rotation) {
    ++dropped_;
    return;
  }
  if (kept_ < held_ && count(splats_) == held_) keep_largest();
  for_each_column(splats_.kernel, [&]<class Each>(const Column<Each>& column) {
    if constexpr (std::is_same_v<Each, std::vector<glm::quat>>)
      column.values.push_back(*rotation);
    else if constexpr (std::is_same_v<Each, std::vector<glm::vec3>>)
      column.values.emplace_back(column.role == ColumnRole::scale ? splat.scales
                                                                  : splat.center - origin_);
    else if (column.role == ColumnRole::opacity)
      column.values.push_back(static_cast<float>(splat.opacity));
    else
      column.values.insert(column.values.end(), values.begin(), values.end());
  });
  auto& colors = splats_.color.coefficients;
  colors.insert(colors.end(), coefficients.begin(), coefficients.end());
  if (keep_rows_) splats_.rows.push_back(static_cast<std::uint32_t>(row));
  if (is_valid(splats_, count(splats_) - 1)) return;
  ++dropped_;
  for_each_array(splats_, [](auto& array, std::size_t each) { array.resize(array.size() - each); });
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
  std::optional<Remark> lowered;
  if (const auto limit = lower_near_limit(splats_)) {
    lowered = Remark{&remarks::near_limit_lowered,
                     {{"radius", middle_bounds(splats_).radius()},
                      {"published", double(profile.min_center_depth)},
                      {"limit", double(*limit)}}};
    splats_.profile.min_center_depth = *limit;
  }
  Scene scene = scene_of(std::move(splats_), origin_);
  scene.info.name = std::filesystem::path(input_.name()).stem().string();
  scene.info.source = format;
  scene.info.up = splat_up;
  scene.info.up_is_assumed = true;
  scene.info.remarks.push_back({&remarks::up_unknown_to_splats, {{"format", format}}});
  if (lowered) scene.info.remarks.push_back(*lowered);
  if (dropped_ > 0)
    scene.info.remarks.push_back(
        {&remarks::splats_dropped, {{"dropped", dropped_}, {"all", added_}}});
  if (kept < valid)
    scene.info.remarks.push_back({&remarks::splats_limited, {{"kept", kept}, {"all", valid}}});
  return scene;
}

}  // namespace tureen
