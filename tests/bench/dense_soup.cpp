#include "tests/bench/dense_soup.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/geometric.hpp>

namespace tureen::test {

namespace {

/// The finaliser of splitmix64 (Steele, Lea, Flood, OOPSLA 2014): a well mixed 64-bit permutation.
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

/// Uniform in [-1, 1).
float signed_unit(std::uint64_t key) { return float(mixed(key) >> 40) / float(1 << 23) - 1.0f; }

glm::vec3 base_color(const TriangleSoup& base, std::size_t face) {
  if (const auto* faces = std::get_if<FaceColors>(&base.appearance))
    return glm::vec3(faces->rgba[face]);
  if (const auto* vertices = std::get_if<VertexColors>(&base.appearance))
    return glm::vec3(vertices->rgba[base.triangles[face].x]);
  return glm::vec3(0.8f);
}

/// Writes the triangles of `corners` after `depth` splits.
void split(const std::array<glm::vec3, 3>& corners, int depth, std::vector<glm::vec3>& out) {
  if (depth == 0) {
    out.insert(out.end(), corners.begin(), corners.end());
    return;
  }
  const auto& [a, b, c] = corners;
  const glm::vec3 ab = 0.5f * (a + b), bc = 0.5f * (b + c), ca = 0.5f * (c + a);
  split({a, ab, ca}, depth - 1, out);
  split({ab, b, bc}, depth - 1, out);
  split({ca, bc, c}, depth - 1, out);
  split({bc, ca, ab}, depth - 1, out);
}

}  // namespace

TriangleSoup dense_soup(const TriangleSoup& base, std::size_t triangles) {
  int depth = 0;
  std::size_t pieces = 1;
  while (!base.triangles.empty() && base.triangles.size() * pieces < triangles) {
    ++depth;
    pieces *= 4;
  }
  const std::size_t count = base.triangles.size() * pieces;
  TriangleSoup soup;
  soup.positions.reserve(3 * count);
  soup.triangles.reserve(count);
  FaceColors colors;
  colors.rgba.reserve(count);
  for (std::size_t face = 0; face < base.triangles.size(); ++face) {
    std::array<glm::vec3, 3> corners;
    for (int k = 0; k < 3; ++k) corners[std::size_t(k)] = base.positions[base.triangles[face][k]];
    split(corners, depth, soup.positions);
    const glm::vec3 color = base_color(base, face);
    for (std::size_t piece = 0; piece < pieces; ++piece) {
      const std::size_t t = soup.triangles.size();
      const auto first = static_cast<std::uint32_t>(3 * t);
      soup.triangles.emplace_back(first, first + 1, first + 2);
      glm::vec3* v = &soup.positions[3 * t];
      const float reach = 0.02f * std::max({glm::distance(v[0], v[1]), glm::distance(v[1], v[2]),
                                            glm::distance(v[2], v[0])});
      for (std::size_t k = 0; k < 3; ++k)
        for (int axis = 0; axis < 3; ++axis)
          v[k][axis] += reach * signed_unit(9 * t + 3 * k + std::size_t(axis));
      glm::vec4 rgba(1.0f);
      for (int c = 0; c < 3; ++c) {
        const float varied = color[c] * 255.0f + 24.0f * signed_unit(~(3 * t + std::size_t(c)));
        rgba[c] = float(int(std::clamp(varied, 0.0f, 255.0f))) / 255.0f;
      }
      colors.rgba.push_back(rgba);
    }
  }
  soup.appearance = std::move(colors);
  return soup;
}

}  // namespace tureen::test
