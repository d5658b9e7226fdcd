// Barycentrics within the triangle. Interpolated at a pixel centre they can lie outside by rounding,
// and on needles by much more; sampling there would extrapolate (docs/numerics.md, T1).
vec2 clamped_to_simplex(vec2 b) {
  b = max(b, 0.0);
  return b / max(b.x + b.y, 1.0);
}
