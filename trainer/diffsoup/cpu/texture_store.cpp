#include "trainer/diffsoup/cpu/texture_store.hpp"

#include <cstring>

#include "trainer/common/cpu/vector_clones.hpp"

namespace tureen::trainer {

namespace {

TUREEN_VECTOR_CLONES void refine(const kernels::Parents* parents, std::size_t count,
                                 const float* coarse, const float* own, float* fine) {
  for (std::size_t i = 0; i < count; ++i) {
    const float* a = coarse + std::size_t(parents[i].a) * channels;
    const float* b = coarse + std::size_t(parents[i].b) * channels;
    for (int c = 0; c < channels; ++c)
      fine[i * channels + c] = own[i * channels + c] + 0.5f * (a[c] + b[c]);
  }
}

TUREEN_VECTOR_CLONES void coarsen(const kernels::Parents* parents, std::size_t count,
                                  const float* fine, float* coarse) {
  for (std::size_t i = 0; i < count; ++i) {
    float* a = coarse + std::size_t(parents[i].a) * channels;
    float* b = coarse + std::size_t(parents[i].b) * channels;
    for (int c = 0; c < channels; ++c) a[c] += 0.5f * fine[i * channels + c];
    for (int c = 0; c < channels; ++c) b[c] += 0.5f * fine[i * channels + c];
  }
}

}  // namespace

Pyramid::Pyramid(int min_level, int max_level)
    : min_level_(min_level),
      max_level_(max_level),
      texels_(kernels::level_begin(min_level, max_level + 1)),
      fine_texels_(lattice::texel_count(max_level)) {
  for (int level = min_level + 1; level <= max_level; ++level) {
    auto& table = parents_.emplace_back();
    for (std::uint32_t i = 0; i < lattice::texel_count(level); ++i) {
      const lattice::Coordinates at = lattice::texel_coordinates(i);
      table.push_back(kernels::parents(at.x, at.y));
    }
  }
}

void Pyramid::sum(const float* logits, float* fine, float* scratch) const {
  // The two buffers alternate; the last level must end in `fine`.
  float* from = parents_.size() % 2 ? scratch : fine;
  float* to = parents_.size() % 2 ? fine : scratch;
  std::size_t count = lattice::texel_count(min_level_);
  std::memcpy(from, logits, count * channels * sizeof(float));
  for (const auto& table : parents_) {
    logits += count * channels;
    count = table.size();
    refine(table.data(), count, from, logits, to);
    std::swap(from, to);
  }
}

void Pyramid::scatter(float* fine, float* logits) const {
  float* level = logits + std::size_t(texels_ - fine_texels_) * channels;
  std::memcpy(level, fine, std::size_t(fine_texels_) * channels * sizeof(float));
  for (std::size_t i = parents_.size(); i-- > 0;) {
    const std::size_t coarse = i ? parents_[i - 1].size() : lattice::texel_count(min_level_);
    float* below = level - coarse * channels;
    std::memset(below, 0, coarse * channels * sizeof(float));
    coarsen(parents_[i].data(), parents_[i].size(), level, below);
    level = below;
  }
}

}  // namespace tureen::trainer
