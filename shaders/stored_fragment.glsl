#ifdef LAYERED
uniform int first_slot;
#endif

// The slot of a fragment within its layer; visibility.frag numbers the slots of all layers in one
// sequence.
uint stored_slot(uvec2 fragment) {
#ifdef LAYERED
  return fragment.x - uint(first_slot);
#else
  return fragment.x;
#endif
}

// The barycentrics that visibility.frag stored: the weights of the face's vertices 0 and 1.
vec2 stored_barycentrics(uvec2 fragment) {
  return vec2(fragment.y & 0xffffu, fragment.y >> 16) / 65535.0;
}
