// Barycentrics clamped to the triangle. Interpolated at a pixel centre, they can lie outside by
// rounding, and for needles by much more; sampling would then extrapolate (docs/numerics.md, T1).
vec2 clamped_to_simplex(vec2 b) {
  b = max(b, 0.0);
  return b / max(b.x + b.y, 1.0);
}
