#include "runtime/face_part.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "soup/lattice.hpp"

namespace tureen {

namespace {

/// Interpolating three alphas of magnitude up to `largest_alpha` in float errs by less than
/// 8 * 2^-24 * 64 < 1e-4: what lies that close below the threshold counts as existing.
constexpr double threshold = double(alpha_threshold) - 1e-4;
constexpr double largest_alpha = 64.0;

/// The least of each barycentric over what exists. Infinite where nothing does.
struct Least {
  glm::dvec3 b{INFINITY};

  /// At (x, y), in texels of a lattice of n.
  void add(double x, double y, int n) { b = glm::min(b, glm::dvec3(x, y, n - x - y) / double(n)); }
};

/// Alpha is linear between the texels of a lattice triangle, so what exists of one has its corners
/// at texels and where lattice edges cross the threshold. Nothing when an alpha is too large.
template <class Value>
std::optional<Least> least_barycentrics(const std::vector<Value>& values,
                                        const LatticePatch& patch) {
  const int n = lattice::resolution(int(patch.level));
  const Value* first =
      &values[std::size_t(patch.first_texel) * LatticeTexture::channels + LatticeTexture::features];
  const auto alpha = [&](int x, int y) {
    const double scale = sizeof(Value) == 1 ? 1.0 / 255.0 : 1.0;
    return double(first[lattice::texel_index(x, y) * LatticeTexture::channels]) * scale;
  };
  Least least;
  for (int y = 0; y <= n; ++y)
    for (int x = 0; x + y <= n; ++x) {
      const double here = alpha(x, y);
      // Negated so that NaN counts as too large.
      if (!(std::abs(here) <= largest_alpha)) return std::nullopt;
      const bool exists = here >= threshold;
      if (exists) least.add(x, y, n);
      const auto edge_to = [&](int other_x, int other_y) {
        const double there = alpha(other_x, other_y);
        if (exists == (there >= threshold)) return;
        const double t = (threshold - here) / (there - here);
        least.add(x + t * (other_x - x), y + t * (other_y - y), n);
      };
      if (x > 0) edge_to(x - 1, y);
      if (y > 0) edge_to(x, y - 1);
      if (y > 0) edge_to(x + 1, y - 1);
    }
  return least;
}

/// Whether the corners of a part, rounded to floats, stay where they are meant to be: within 1e-4
/// of the face's height, a hundredth of the margin.
bool rounds_well(const TriangleSoup& soup, std::uint32_t face) {
  const glm::uvec3& t = soup.triangles[face];
  const glm::dvec3 a = soup.positions[t.x], b = soup.positions[t.y], c = soup.positions[t.z];
  const double longest = std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
  const double height = glm::length(glm::cross(b - a, c - a)) / longest;
  const double farthest = std::max({glm::length(a), glm::length(b), glm::length(c)});
  return farthest * 0x1p-23 <= 1e-4 * height;
}

}  // namespace

FacePart existing_part(const TriangleSoup& soup, const LatticeTexture& texture,
                       std::uint32_t face) {
  if (!rounds_well(soup, face)) return whole_face;
  const std::optional<Least> least = std::visit(
      [&](const auto& values) { return least_barycentrics(values, texture.patches[face]); },
      texture.texels);
  if (!least || least->b.x == INFINITY) return whole_face;
  const glm::dvec3 b = least->b - part_margin;
  if (std::min({b.x, b.y, b.z}) <= 0) return whole_face;
  // At corner k the barycentrics other than k are least.
  const double side = 1.0 - b.x - b.y - b.z;
  return {glm::dvec2(b.x + side, b.y), glm::dvec2(b.x, b.y + side), glm::dvec2(b.x, b.y)};
}

double area_share(const FacePart& part) {
  const glm::dvec2 u = part[0] - part[2], v = part[1] - part[2];
  return std::abs(u.x * v.y - u.y * v.x);
}

}  // namespace tureen
