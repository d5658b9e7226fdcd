#include "trainer/diffsoup/levels.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "trainer/diffsoup/kernels/texture.hpp"

namespace tureen::trainer::levels {

namespace {

using kernels::Parents;

std::vector<Parents> parents_of(int level) {
  std::vector<Parents> parents(lattice::texel_count(level));
  for (std::uint32_t texel = 0; texel < parents.size(); ++texel) {
    const auto [x, y] = lattice::texel_coordinates(texel);
    parents[texel] = kernels::parents(x, y);
  }
  return parents;
}

const std::vector<Parents>& parents(int level) {
  static const auto tables = [] {
    std::array<std::vector<Parents>, lattice::max_level + 1> all;
    for (int l = 1; l <= lattice::max_level; ++l) all[l] = parents_of(l);
    return all;
  }();
  return tables[level];
}

/// Refines `values`, which holds level - 1 at its front, to `level`. The loop runs backwards
/// because a texel's parents never have a higher index.
void refine_in_place(int level, int channels, std::span<float> values) {
  const std::vector<Parents>& table = parents(level);
  for (std::size_t texel = table.size(); texel-- > 0;) {
    const float* a = &values[std::size_t(table[texel].a) * channels];
    const float* b = &values[std::size_t(table[texel].b) * channels];
    float* out = &values[texel * channels];
    for (int c = 0; c < channels; ++c) out[c] = 0.5f * (a[c] + b[c]);
  }
}

}  // namespace

void accumulate(int min, int max, int channels, std::span<const float> all, std::span<float> fine) {
  assert(0 <= min && min <= max && max <= lattice::max_level);
  assert(all.size() == texel_count(min, max) * channels);
  assert(fine.size() == std::size_t(lattice::texel_count(max)) * channels);
  const float* level_values = all.data();
  for (int level = min; level <= max; ++level) {
    const std::size_t count = std::size_t(lattice::texel_count(level)) * channels;
    if (level == min) {
      std::copy_n(level_values, count, fine.begin());
    } else {
      refine_in_place(level, channels, fine);
      for (std::size_t i = 0; i < count; ++i) fine[i] += level_values[i];
    }
    level_values += count;
  }
}

void coarsen(int from, int to, int channels, std::span<const float> fine, std::span<float> coarse) {
  assert(to <= from);
  const int stride = 1 << (from - to);
  for (std::uint32_t texel = 0; texel < lattice::texel_count(to); ++texel) {
    const auto [x, y] = lattice::texel_coordinates(texel);
    const std::size_t at = lattice::texel_index(x * stride, y * stride);
    std::copy_n(&fine[at * channels], channels, &coarse[std::size_t(texel) * channels]);
  }
}

void decompose(int min, int max, int channels, std::span<const float> fine, std::span<float> all) {
  assert(0 <= min && min <= max && max <= lattice::max_level);
  assert(all.size() == texel_count(min, max) * channels);
  assert(fine.size() == std::size_t(lattice::texel_count(max)) * channels);
  // Residuals are relative to the float sum of the lower levels, so rounding errors do not
  // accumulate.
  std::vector<float> sum(fine.size());
  float* level_values = all.data();
  for (int level = min; level <= max; ++level) {
    const std::size_t count = std::size_t(lattice::texel_count(level)) * channels;
    coarsen(max, level, channels, fine, std::span(level_values, count));
    if (level == min) {
      std::copy_n(level_values, count, sum.begin());
    } else {
      refine_in_place(level, channels, sum);
      for (std::size_t i = 0; i < count; ++i) {
        level_values[i] -= sum[i];
        sum[i] += level_values[i];
      }
    }
    level_values += count;
  }
}

}  // namespace tureen::trainer::levels
