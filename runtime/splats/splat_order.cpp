#include "runtime/splats/splat_order.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <utility>

#include "runtime/plan/splat_plan.hpp"

namespace tureen {

namespace {

/// Unsigned integers in the order of the floats. -0 equals 0, so that ties stay ties.
std::uint32_t key_of(float depth) {
  if (depth == 0.0f) depth = 0.0f;  // of -0
  std::uint32_t bits = 0;
  std::memcpy(&bits, &depth, sizeof bits);  // Emscripten's library lacks std::bit_cast
  return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}

bool is_kept(std::size_t index, float fraction) {
  // Wang's integer hash.
  auto h = static_cast<std::uint32_t>(index);
  h = (h ^ 61u ^ (h >> 16)) * 9u;
  h = (h ^ (h >> 4)) * 0x27d4eb2du;
  h ^= h >> 15;
  return static_cast<float>(h) < fraction * 4294967296.0f;
}

// Three passes over 11 bits were the fastest of 8, 11 and 16 bits for 100,000 splats.
constexpr int digit_bits = 11;
constexpr int digits = 3;
constexpr std::uint32_t digit_values = 1u << digit_bits;

std::uint32_t digit(std::uint32_t key, int place) {
  return (key >> (place * digit_bits)) & (digit_values - 1);
}

}  // namespace

bool has_splats_of(std::span<const SplatsInView> sorted, std::span<const SplatsInView> views) {
  return std::equal(sorted.begin(), sorted.end(), views.begin(), views.end(),
                    [](const SplatsInView& has, const SplatsInView& needs) {
                      if (has.centers.data() != needs.centers.data() ||
                          has.centers.size() != needs.centers.size())
                        return false;
                      for (std::size_t chunk = 0; chunk < has.behind.size(); ++chunk)
                        if (has.skips(chunk) && !needs.skips(chunk)) return false;
                      return true;
                    });
}

bool serves(std::span<const SplatsInView> sorted, std::span<const SplatsInView> views) {
  // Differences of offsets matter only between layers.
  return has_splats_of(sorted, views) &&
         std::equal(sorted.begin(), sorted.end(), views.begin(),
                    [&](const SplatsInView& a, const SplatsInView& b) {
                      return a.axis == b.axis && (views.size() == 1 || a.offset == b.offset);
                    });
}

/// Least significant digit first, which keeps the order of equal keys.
void SplatOrder::sort_by_key() {
  std::array<std::array<std::uint32_t, digit_values>, digits> counts{};
  for (const Entry& entry : entries_)
    for (int place = 0; place < digits; ++place)
      ++counts[std::size_t(place)][digit(entry.key, place)];
  scratch_.resize(entries_.size());
  for (int place = 0; place < digits; ++place) {
    std::array<std::uint32_t, digit_values>& next = counts[std::size_t(place)];
    std::uint32_t sum = 0;
    for (std::uint32_t& count : next) sum += std::exchange(count, sum);
    for (const Entry& entry : entries_) scratch_[next[digit(entry.key, place)]++] = entry;
    entries_.swap(scratch_);
  }
}

void SplatOrder::make_runs(std::span<const SplatsInView> layers) {
  std::vector<std::uint32_t> ends;  // of the layers' places
  std::uint32_t end = 0;
  for (const SplatsInView& layer : layers)
    ends.push_back(end += static_cast<std::uint32_t>(layer.centers.size()));
  splats_.resize(entries_.size());
  runs_.clear();
  for (std::uint32_t i = 0; i < entries_.size(); ++i) {
    const std::uint32_t place = entries_[i].place;
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
      if (std::isfinite(depth)) entries_.push_back({key_of(depth), place + std::uint32_t(i)});
    }
    place += static_cast<std::uint32_t>(layer.centers.size());
  }
  sort_by_key();
  make_runs(layers);
}

}  // namespace tureen
