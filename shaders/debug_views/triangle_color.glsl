// A bright colour a face; runtime/debug_views/debug_view.cpp has the same colours, and a test
// compares the two.
uint mixed_bits(uint x) {
  x = (x ^ (x >> 16)) * 0x7feb352du;
  x = (x ^ (x >> 15)) * 0x846ca68bu;
  return x ^ (x >> 16);
}

vec3 triangle_color(uint face, uint layer) {
  uint h = mixed_bits(face + 1u + layer * 0x9e3779b9u);
  return 0.25 + 0.75 / 255.0 * vec3(h & 255u, (h >> 8) & 255u, (h >> 16) & 255u);
}
