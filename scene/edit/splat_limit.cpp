#include "scene/edit/splat_limit.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "scene/edit/splat_edits.hpp"
#include "scene/scene_remarks.hpp"

namespace tureen {

std::vector<double> splat_contributions(const SplatKernel& kernel) {
  std::vector<double> result(count(kernel));
  std::visit(
      [&](const auto& each) {
        for (std::size_t i = 0; i < result.size(); ++i) result[i] = contribution(each, i);
      },
      kernel);
  // A reader may not have rejected its values yet.
  for (double& each : result)
    if (std::isnan(each)) each = 0;
  return result;
}

std::vector<std::uint8_t> largest_splats(const SplatKernel& kernel, std::size_t max) {
  const std::vector<double> contributions = splat_contributions(kernel);
  const std::size_t all = contributions.size();
  if (all <= max) return std::vector<std::uint8_t>(all, 1);
  std::vector<std::uint32_t> order(all);
  std::iota(order.begin(), order.end(), 0u);
  // Of equal splats the first stay, so that the result does not depend on the library.
  std::nth_element(
      order.begin(), order.begin() + std::ptrdiff_t(max), order.end(),
      [&](std::uint32_t a, std::uint32_t b) {
        return contributions[a] != contributions[b] ? contributions[a] > contributions[b] : a < b;
      });
  std::vector<std::uint8_t> keeps(all, 0);
  for (std::size_t i = 0; i < max; ++i) keeps[order[i]] = 1;
  return keeps;
}

Splats largest_splats(Splats splats, std::size_t max) {
  if (count(splats) <= max) return splats;
  const std::vector<std::uint8_t> keeps = largest_splats(splats.kernel, max);
  return keep_splats(std::move(splats), keeps);
}

std::size_t share_of(std::uint64_t splats, std::uint64_t before, std::uint64_t max,
                     std::uint64_t all) {
  // The product first: the quotient of an exact multiple is exact.
  const auto up_to = [&](std::uint64_t count) {
    return static_cast<std::size_t>(double(max) * double(count) / double(all));
  };
  return std::max<std::size_t>(up_to(before + splats) - up_to(before), 1);
}

void limit_splats(Scene& scene, std::uint64_t max) {
  std::uint64_t all = 0, before = 0, kept = 0;
  for (const Layer& layer : scene.layers)
    if (const auto* splats = std::get_if<Splats>(&layer.primitives)) all += count(*splats);
  if (all <= max) return;
  for (Layer& layer : scene.layers) {
    auto* splats = std::get_if<Splats>(&layer.primitives);
    if (!splats || count(*splats) == 0) continue;
    const std::size_t number = count(*splats);
    *splats = largest_splats(std::move(*splats), share_of(number, before, max, all));
    before += number;
    kept += count(*splats);
  }
  scene.info.remarks.push_back({&remarks::splats_limited, {{"kept", kept}, {"all", all}}});
}

}  // namespace tureen
