// The triangular lattice of one face; scene/lattice.hpp has the same definition, and a test
// compares the two.
struct LatticeFootprint {
  uvec3 texels;
  vec3 weights;
};

uint lattice_texel_index(int x, int y) {
  int diagonal = x + y;
  return uint(diagonal * (diagonal + 1) / 2 + y);
}

// The cell of a point, and the position in it in texels: (0, 0) at its corner (x, y).
struct LatticeCell {
  int x, y;
  vec2 p;
};

LatticeCell lattice_cell(int level, vec2 b) {
  int n = 1 << level;
  vec2 p = b * float(n);
  int x = int(clamp(floor(p.x), 0.0, float(n - 1)));
  int y = int(clamp(floor(p.y), 0.0, float(n - 1 - x)));
  return LatticeCell(x, y, p - vec2(float(x), float(y)));
}

// Weights of the corners (x + 1, y), (x, y + 1) and a third: (x + 1, y + 1) where `upper`, else (x, y).
vec3 lattice_weights(vec2 p, out bool upper) {
  upper = p.x + p.y > 1.0;
  vec2 w = upper ? 1.0 - p.yx : p;
  return vec3(w, 1.0 - w.x - w.y);
}

LatticeFootprint lattice_footprint(int level, vec2 b) {
  LatticeCell cell = lattice_cell(level, b);
  bool upper;
  vec3 weights = lattice_weights(cell.p, upper);
  // On the last diagonal the fourth corner lies outside the lattice: the border texel replaces it.
  int corner_y = min(cell.y + 1, (1 << level) - (cell.x + 1));
  uint third = upper ? lattice_texel_index(cell.x + 1, corner_y) : lattice_texel_index(cell.x, cell.y);
  return LatticeFootprint(uvec3(lattice_texel_index(cell.x + 1, cell.y),
                                lattice_texel_index(cell.x, cell.y + 1), third),
                          weights);
}
