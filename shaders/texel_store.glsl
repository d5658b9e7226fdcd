// A linear array of texels kept in a 2D array texture: rows of 2^TEXEL_ROW_BITS texels, layers of
// 2^TEXEL_LAYER_BITS rows. runtime/passes/texel_store.hpp defines the same layout.
ivec3 texel_position(uint index) {
  return ivec3(int(index & ((1u << TEXEL_ROW_BITS) - 1u)),
               int((index >> TEXEL_ROW_BITS) & ((1u << TEXEL_LAYER_BITS) - 1u)),
               int(index >> (TEXEL_ROW_BITS + TEXEL_LAYER_BITS)));
}
