// The visible face of each pixel.
#pragma once

#include "trainer/diffsoup/backend.hpp"
#include "trainer/diffsoup/cpu/batch_image.hpp"
#include "trainer/diffsoup/cpu/texture_store.hpp"

namespace tureen::trainer {

/// Projects all faces and sorts them into tiles.
void bin_faces(BatchImage& image, const Model& model);

/// Fills image.visible in one tile and, if image.keeps_fragments, lists the tile's fragments with a
/// gradient. At equal depths the lower face wins. Returns the number of tested fragments.
std::uint64_t find_visible(BatchImage& image, std::size_t tile, const float* alpha, int level,
                           Masking masking);

/// Lists the tiles of each face with fragments, after find_visible() in all tiles. Needs
/// image.keeps_fragments.
void list_faces(BatchImage& image);

}  // namespace tureen::trainer
