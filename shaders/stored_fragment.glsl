// The barycentrics that visibility.frag stored: the weights of the face's vertices 0 and 1.
vec2 stored_barycentrics(uvec2 fragment) {
  return vec2(fragment.y & 0xffffu, fragment.y >> 16) / 65535.0;
}
