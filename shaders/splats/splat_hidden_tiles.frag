// Whether a tile is hidden: whether all its pixels, or all finer tiles in it, are.
uniform sampler2D finer;  // blended splats; or finer tiles
uniform ivec2 finer_size;
uniform float min_alpha;  // of a hidden pixel

layout(location = 0) out float hidden;

bool is_hidden(ivec2 at) {
#if FROM_PIXELS
  // Outside the image is nothing to see.
  return at.x >= finer_size.x || at.y >= finer_size.y || texelFetch(finer, at, 0).a >= min_alpha;
#else
  return texelFetch(finer, at, 0).r > 0.5;
#endif
}

void main() {
  ivec2 corner = SIDE * ivec2(gl_FragCoord.xy);
  hidden = 0.0;
  for (int y = 0; y < SIDE; ++y)
    for (int x = 0; x < SIDE; ++x)
      if (!is_hidden(corner + ivec2(x, y))) return;
  hidden = 1.0;
}
