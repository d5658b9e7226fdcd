#include "runtime/splats/splat_order.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

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

void SplatOrder::make_runs(std::span<const SplatsInView> layers) {
  std::vector<std::uint32_t> ends;  // of the layers' places
  std::uint32_t end = 0;
  for (const SplatsInView& layer : layers)
    ends.push_back(end += static_cast<std::uint32_t>(layer.centers.size()));
  splats_.resize(entries_.size());
  runs_.clear();
  for (std::uint32_t i = 0; i < entries_.size(); ++i) {
    const std::uint32_t place = entries_[i].index;
    std::uint32_t layer = runs_.empty() ? 0 : runs_.back().layer;
    while (place >= ends[layer]) ++layer;
    while (layer > 0 && place < ends[layer - 1]) --layer;
    splats_[i] = place - (layer > 0 ? ends[layer - 1] : 0);
    if (runs_.empty() || runs_.back().layer != layer) runs_.push_back({layer, i, 0});
    ++runs_.back().count;
  }
}

void SplatOrder::sort(std::span<const SplatsInView> layers) {
  entries_.clear();
  std::uint32_t place = 0;
  for (const SplatsInView& layer : layers) {
    for (std::size_t i = 0; i < layer.centers.size(); ++i) {
      if (layer.skips(i / splats_per_chunk)) continue;
      if (layer.fraction < 1 && !is_kept(i, layer.fraction)) continue;
      const auto depth =
          static_cast<float>(glm::dot(layer.axis, glm::dvec3(layer.centers[i])) - layer.offset);
      if (std::isfinite(depth)) entries_.push_back({sort_key(depth), place + std::uint32_t(i)});
    }
    place += static_cast<std::uint32_t>(layer.centers.size());
  }
  radix_sort(entries_, scratch_);
  make_runs(layers);
}

}  // namespace tureen
