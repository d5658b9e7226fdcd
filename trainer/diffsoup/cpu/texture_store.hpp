// The textures of all faces for fragments: the sigmoid of the sum over all levels. They persist
// between steps; only changed faces are refreshed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "trainer/diffsoup/kernels/texel_pack.hpp"
#include "trainer/diffsoup/kernels/texture.hpp"
#include "trainer/diffsoup/model.hpp"

namespace tureen::trainer {

/// The layout of the levels of a texture, and the parents of each texel.
class Pyramid {
 public:
  Pyramid(int min_level, int max_level);

  int max_level() const { return max_level_; }
  std::uint32_t texels() const { return texels_; }            // of all levels
  std::uint32_t fine_texels() const { return fine_texels_; }  // of max_level

  /// Interpolates all levels at the texels of max_level and sums them. `logits`:
  /// [texels][channels]. `fine`: output, [fine_texels][channels]. `scratch` has the size of `fine`.
  void sum(const float* logits, float* fine, float* scratch) const;

  /// The transpose: from the gradient at the texels of max_level to the gradient of all levels.
  void scatter(float* fine, float* logits) const;

 private:
  int min_level_, max_level_;
  std::uint32_t texels_, fine_texels_;
  std::vector<std::vector<kernels::Parents>> parents_;  // of level min + 1 + i
};

struct TextureStore {
  std::vector<Texel> values;  // [face][fine texel]
  std::vector<float> alpha;   // [face][fine texel]: a copy of channel 7, for the visibility test
};

}  // namespace tureen::trainer
