// Vertices of stochastic splats: the depth of a splat is that of its centre, so the depth test keeps
// the splat with the nearest centre.
#if OUTPUT == OUTPUT_SAMPLE
uniform float nearest;         // the near plane
uniform vec2 ndc_from_stored;  // factor and summand

flat out uint sampled_splat;

// The position with a depth, from 0 to 1, that decreases with the depth of the centre, which may be
// before the near plane. It is the same at all vertices, so all fragments have it. Without clip
// control its step is 6e-8 everywhere; by the logarithm, 3e-6 of the depth at any depth, up to 2^32
// near planes.
vec4 at_center_depth(vec4 position, float depth, uint splat) {
  sampled_splat = splat;
  float stored = depth >= nearest ? max(0.5 - log2(depth / nearest) / 64.0, 1e-6)
                                  : 1.0 - 0.5 / (2.0 - depth / nearest);
  return vec4(position.xy, (stored * ndc_from_stored.x + ndc_from_stored.y) * position.w, position.w);
}
#else
// Other outputs leave the depth as it is.
vec4 at_center_depth(vec4 position, float depth, uint splat) { return position; }
#endif
