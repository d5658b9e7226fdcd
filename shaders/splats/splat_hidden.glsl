// Whether earlier splats hide a part of the image (runtime/splats/hidden_tiles.hpp).
#if OUTPUT == OUTPUT_COLOR
uniform bool skips_hidden;
uniform sampler2D hidden;  // 1 where a tile is hidden; HIDDEN_LEVELS levels

// For the pixels from `low` to `high`. `half_size`: of the image, in pixels.
bool is_hidden(vec2 low, vec2 high, vec2 half_size) {
  if (!skips_hidden) return false;
  vec2 last_pixel = 2.0 * half_size - 1.0;
  ivec2 first = ivec2(clamp(low, vec2(0.0), last_pixel)) / HIDDEN_TILE_SIDE;
  ivec2 last = ivec2(clamp(high, vec2(0.0), last_pixel)) / HIDDEN_TILE_SIDE;
  // On the finest level where the box has at most 3 x 3 tiles.
  int level = 0;
  for (; level < HIDDEN_LEVELS - 1 && max(last.x - first.x, last.y - first.y) > 2; ++level) {
    first /= 2;
    last /= 2;
  }
  if (max(last.x - first.x, last.y - first.y) > 2) return false;
  for (int y = first.y; y <= last.y; ++y)
    for (int x = first.x; x <= last.x; ++x)
      if (texelFetch(hidden, ivec2(x, y), level).r < 0.5) return false;
  return true;
}
#else
bool is_hidden(vec2 low, vec2 high, vec2 half_size) { return false; }
#endif
