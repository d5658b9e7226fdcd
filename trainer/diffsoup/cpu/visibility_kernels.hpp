// The fragments of a tile's faces, in vectors.
#pragma once

#include "trainer/diffsoup/backend.hpp"
#include "trainer/diffsoup/cpu/batch_image.hpp"

namespace tureen::trainer {

/// Which fragments are accepted.
struct AlphaTest {
  const float* alpha;  // TextureStore::alpha
  int level;           // of the lattice
  Masking masking;
};

struct TileVisibility {
  std::uint64_t fragments = 0;  // tested
  std::uint32_t end = 0;        // faces from this entry of BatchImage::bins on are hidden
};

/// Fills image.visible in the tile. If image.keeps_fragments, it lists the fragments that were
/// nearer than all accepted ones before them, in image.fragments and image.fragments_end up to
/// the returned entry; none is marked as visible, and some lie behind the visible ones.
TileVisibility draw_tile(BatchImage& image, std::size_t tile, const AlphaTest& test);

}  // namespace tureen::trainer
