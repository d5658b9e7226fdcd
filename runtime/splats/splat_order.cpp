#include "runtime/splats/splat_order.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "runtime/plan/splat_plan.hpp"

namespace tureen {

namespace {

bool is_kept(std::size_t index, float fraction) {
  // Wang's integer hash.
  auto h = static_cast<std::uint32_t>(index);
  h = (h ^ 61u ^ (h >> 16)) * 9u;
  h = (h ^ (h >> 4)) * 0x27d4eb2du;
  h ^= h >> 15;
  return static_cast<float>(h) < fraction * 4294967296.0f;
}

/// Whether `sorted` skips only chunks that the flags of `views` allow to miss.
bool have_splats(std::span<const SplatsInView> sorted, std::span<const SplatsInView> views,
                 std::vector<bool> SplatsInView::*may_miss) {
  return std::equal(sorted.begin(), sorted.end(), views.begin(), views.end(),
                    [&](const SplatsInView& has, const SplatsInView& needs) {
                      if (has.centers.data() != needs.centers.data() ||
                          has.centers.size() != needs.centers.size())
                        return false;
                      const std::vector<bool>& allowed = needs.*may_miss;
                      for (std::size_t chunk = 0; chunk < has.behind.size(); ++chunk)
                        if (has.skips(chunk) && !(chunk < allowed.size() && allowed[chunk]))
                          return false;
                      return true;
                    });
}

}  // namespace

bool has_visible_splats_of(std::span<const SplatsInView> sorted,
                           std::span<const SplatsInView> views) {
  return have_splats(sorted, views, &SplatsInView::outside);
}

bool serves(std::span<const SplatsInView> sorted, std::span<const SplatsInView> views) {
  // Differences of offsets matter only between layers.
  return have_splats(sorted, views, &SplatsInView::behind) &&
         std::equal(sorted.begin(), sorted.end(), views.begin(),
                    [&](const SplatsInView& a, const SplatsInView& b) {
                      return a.axis == b.axis && (views.size() == 1 || a.offset == b.offset);
                    });
}

bool lags_little(std::span<const SplatsInView> sorted, std::span<const SplatsInView> views) {
  return std::equal(sorted.begin(), sorted.end(), views.begin(), views.end(),
                    [](const SplatsInView& a, const SplatsInView& b) {
                      return glm::length(glm::cross(a.axis, b.axis)) <= std::sin(max_order_lag) *
                                                                            glm::length(a.axis) *
                                                                            glm::length(b.axis) &&
                             glm::dot(a.axis, b.axis) >= 0;
                    });
}

void SplatOrder::sort(std::span<const SplatsInView> layers) {
  begin();
  for (const SplatsInView& layer : layers)
    add_layer(layer.centers.size(), [&](std::uint32_t i) {
      if (layer.skips(i / splats_per_chunk) || (layer.fraction < 1 && !is_kept(i, layer.fraction)))
        return std::numeric_limits<float>::quiet_NaN();
      return static_cast<float>(glm::dot(layer.axis, glm::dvec3(layer.centers[i])) - layer.offset);
    });
  DepthOrder::sort();
  make_runs();
}

}  // namespace tureen
