#include "trainer/diffsoup/cpu/corner_gradient.hpp"

namespace tureen::trainer {

void collect_fragments(BatchImage& image, std::size_t tile) {
  std::vector<GradientFragment>& fragments = image.fragments[tile];
  const std::uint32_t end = image.bin_begin[tile + 1];
  const bool empty = image.bin_begin[tile] == end;
  image.by_features[tile].resize(empty ? 0 : image.visible_end[end - 1]);
  auto next = image.by_features[tile].begin();
  for (std::size_t i = 0; i < (empty ? 0 : image.fragments_end[end - 1]); ++i) {
    const std::size_t pixel = image.pixel_of(fragments[i]);
    fragments[i].depth_or_factor = image.loss[pixel];
    if (fragments[i].visible) *next++ = image.features[pixel];
  }
}

}  // namespace tureen::trainer
