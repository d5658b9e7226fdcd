// The tiles of 16 x 16 pixels in which the published rasterisers draw a Gaussian: those that the
// square of a radius around a point of the image touches (getRect() of 3DGS).

// The target's lower left corner in the whole image, in pixels from its top left corner.
uniform vec2 whole_corner;

// From pixels of the target, y upwards, to pixels of the whole image, y downwards.
vec2 in_whole_image(vec2 pixel) {
  return vec2(whole_corner.x + pixel.x, whole_corner.y - pixel.y);
}

// The smallest x and y, then the largest.
vec4 tiles_around(vec2 center, float radius) {
  return 16.0 * floor(vec4(center - radius, center + (radius + 15.0)) / 16.0);
}

bool is_in_tiles(vec4 tiles, vec2 pixel) {
  vec2 at = in_whole_image(pixel);
  return all(greaterThan(at, tiles.xy)) && all(lessThan(at, tiles.zw));
}
