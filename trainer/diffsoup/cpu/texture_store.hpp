// The textures of all faces as fragments see them: summed over levels and through the sigmoid.
// They are kept from step to step and made anew only for faces that changed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "trainer/diffsoup/kernels/texture.hpp"
#include "trainer/diffsoup/model.hpp"

namespace tureen::trainer {

/// How the levels of a texture lie and hang together.
class Pyramid {
 public:
  Pyramid(int min_level, int max_level);

  int max_level() const { return max_level_; }
  std::uint32_t texels() const { return texels_; }            // of all levels
  std::uint32_t fine_texels() const { return fine_texels_; }  // of max_level

  /// Sums what all levels interpolate at the texels of max_level. `logits` [texels][channels],
  /// `fine` [fine_texels][channels]; `scratch` is as large as `fine`.
  void sum(const float* logits, float* fine, float* scratch) const;

  /// The transpose: from the gradient at the texels of max_level to that of all levels' texels.
  /// `fine` is used up.
  void scatter(float* fine, float* logits) const;

 private:
  int min_level_, max_level_;
  std::uint32_t texels_, fine_texels_;
  std::vector<std::vector<kernels::Parents>> parents_;  // of level min + 1 + i
};

struct TextureStore {
  std::vector<float> values;  // [face][fine texel][channels]
  std::vector<float> alpha;   // [face][fine texel]: channel 7 again, for who needs nothing else
};

}  // namespace tureen::trainer
