// Which face each pixel shows.
#pragma once

#include "trainer/diffsoup/backend.hpp"
#include "trainer/diffsoup/cpu/batch_image.hpp"
#include "trainer/diffsoup/cpu/texture_store.hpp"

namespace tureen::trainer {

/// Projects all faces and sorts them into tiles.
void bin_faces(BatchImage& image, const Model& model);

/// Fills image.visible of one tile. Of equal depths the lower face wins. Returns how many
/// fragments there were.
std::uint64_t find_visible(BatchImage& image, std::size_t tile, const float* alpha, int level,
                           Masking masking);

}  // namespace tureen::trainer
