// The triangular lattice of one face; soup/lattice.hpp states the same rule, a test holds them equal.
struct LatticeFootprint {
  uvec3 texels;
  vec3 weights;
};

uint lattice_texel_index(int x, int y) {
  int diagonal = x + y;
  return uint(diagonal * (diagonal + 1) / 2 + y);
}

LatticeFootprint lattice_footprint(int level, vec2 b) {
  int n = 1 << level;
  vec2 p = b * float(n);
  int x = int(clamp(floor(p.x), 0.0, float(n - 1)));
  int y = int(clamp(floor(p.y), 0.0, float(n - 1 - x)));
  p -= vec2(float(x), float(y));
  uint right = lattice_texel_index(x + 1, y);
  uint up = lattice_texel_index(x, y + 1);
  if (p.x + p.y > 1.0) {
    uint corner = lattice_texel_index(x + 1, min(y + 1, n - (x + 1)));
    vec2 w = 1.0 - p.yx;
    return LatticeFootprint(uvec3(right, up, corner), vec3(w, 1.0 - w.x - w.y));
  }
  return LatticeFootprint(uvec3(right, up, lattice_texel_index(x, y)),
                          vec3(p, 1.0 - p.x - p.y));
}
