// Which face each pixel shows.
#pragma once

#include "trainer/backend.hpp"
#include "trainer/cpu/picture.hpp"
#include "trainer/cpu/texture_store.hpp"

namespace tureen::trainer {

/// Projects all faces and sorts them into tiles. `positions` are nine floats a face.
void bin_faces(Picture& picture, const float* positions, std::size_t faces);

/// Fills winner, b0, b1 and inverse_depth of one tile. Of equal depths the lower face wins.
void find_visible(Picture& picture, std::size_t tile, const float* alpha, int level,
                  Masking masking);

}  // namespace tureen::trainer
