#include "trainer/diffsoup/cpu/advantage.hpp"

#include <algorithm>
#include <cmath>

#include "trainer/common/cpu/vector_clones.hpp"

namespace tureen::trainer {

namespace {

// Pixels of a block: arrays of this length stay in the first-level cache, and loops over them are
// vectors.
constexpr int block_size = 64;

/// A block in progress.
struct Block {
  std::size_t first;  // pixel of the image
  int size;
  alignas(64) std::int32_t seen[block_size];    // 0 for ignored pixels, otherwise 1
  alignas(64) std::int32_t counts[block_size];  // 1 for seen pixels with a finite colour
};

TUREEN_ALWAYS_INLINE void find_counted(const BatchImage& image, const TrainingView& view,
                                       Block& block) {
  std::fill_n(block.seen, block.size, 1);
  if (!view.ignored.empty())
    for (int i = 0; i < block.size; ++i)
      block.seen[i] = view.ignored[block.first + std::size_t(i)] ? 0 : 1;
  const std::size_t plane = image.pixels();
  const float* color = image.color.data() + block.first;
  for (int i = 0; i < block.size; ++i) {
    // NaN and infinity times zero are NaN.
    const float zero = color[i] * 0 + color[plane + i] * 0 + color[2 * plane + i] * 0;
    block.counts[i] = zero == 0 ? block.seen[i] : 0;
  }
}

/// Adds squared differences to sixteen sums, which fixes the order of the additions.
TUREEN_ALWAYS_INLINE void add_squared(const BatchImage& image, const TrainingView& view,
                                      const Block& block, double (&sums)[16]) {
  for (std::size_t c = 0; c < 3; ++c) {
    const float* color = image.color.data() + c * image.pixels() + block.first;
    const std::uint8_t* target = view.target.data() + c * image.pixels() + block.first;
    alignas(64) double squared[block_size] = {};
    for (int i = 0; i < block.size; ++i) {
      const double d = color[i] - target[i] / 255.0;
      squared[i] = block.seen[i] && d * 0 == 0 ? d * d : 0.0;
    }
    for (int i = 0; i < block_size; i += 16)
      for (int l = 0; l < 16; ++l) sums[l] += squared[i + l];
  }
}

TUREEN_ALWAYS_INLINE void subtract_baseline(float* __restrict loss, std::uint16_t* __restrict mean,
                                            const Block& block, float rate) {
  for (int i = 0; i < block.size; ++i) {
    const int stored = mean[i];
    const float root = float(stored) / 65535;
    const float before = 3 * root * root;  // of sum |C - G|, which is in [0, 3]
    const float counted = block.counts[i] ? loss[i] : 0.0f;
    const float next = stored ? before + rate * (counted - before) : counted;
    float code = 65535 * std::sqrt(next / 3) + 0.5f;
    code = code > 1.0f ? code : 1.0f;
    code = code < 65535.0f ? code : 65535.0f;
    mean[i] = std::uint16_t(block.counts[i] ? int(code) : stored);
    // An ignored pixel has a loss of 0, which must not change the running mean.
    loss[i] = block.counts[i] ? counted - before : loss[i];
  }
}

}  // namespace

TUREEN_VECTOR_CLONES BandReport take_advantage(BatchImage& image, const AdvantageInput& input,
                                               int y0, int y1) {
  BandReport report;
  const std::size_t width = std::size_t(image.view.width);
  const std::size_t end = std::size_t(y1) * width;
  double sums[16] = {};
  Block block;
  for (block.first = std::size_t(y0) * width; block.first < end; block.first += block_size) {
    block.size = int(std::min<std::size_t>(block_size, end - block.first));
    find_counted(image, *input.view, block);
    add_squared(image, *input.view, block, sums);
    float* loss = image.loss.data() + block.first;
    if (input.baseline)
      subtract_baseline(loss, input.baseline + block.first, block, input.baseline_rate);
    for (int i = 0; i < block.size; ++i) loss[i] *= input.scale;
    const VisiblePixel* visible = image.visible.data() + block.first;
    for (int i = 0; i < block.size; ++i) report.shaded += visible[i].face != no_face;
  }
  for (const double sum : sums) report.squared += sum;
  return report;
}

}  // namespace tureen::trainer
