// What visibility.frag has stored of a fragment: the weights of its face's first two vertices.
vec2 stored_barycentrics(uvec2 fragment) {
  return vec2(fragment.y & 0xffffu, fragment.y >> 16) / 65535.0;
}
