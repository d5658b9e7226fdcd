#include "runtime/plan/draw_order.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>

#include "scene/morton.hpp"

namespace tureen {

namespace {

std::array<glm::vec3, 3> corners(const TriangleSoup& soup, std::uint32_t face) {
  const glm::uvec3& t = soup.triangles[face];
  return {soup.positions[t.x], soup.positions[t.y], soup.positions[t.z]};
}

struct SortKey {
  std::uint64_t curve;  // Morton code of the centroid
  std::uint64_t hash;   // of the corners: brings coincident faces together within one code
  std::uint32_t face;
};

std::uint64_t hash_of(const std::array<glm::vec3, 3>& points) {
  std::uint64_t hash = 0xcbf29ce484222325;  // FNV-1a over words
  for (const glm::vec3& p : points)
    for (int c = 0; c < 3; ++c) {
      std::uint32_t bits;
      std::memcpy(&bits, &p[c], sizeof bits);
      hash = (hash ^ bits) * 0x100000001b3;
    }
  return hash;
}

}  // namespace

void sort_spatially(const TriangleSoup& soup, std::vector<std::uint32_t>& faces) {
  const Bounds box = bounds(soup);
  const glm::dvec3 size = glm::dvec3(box.high) - glm::dvec3(box.low);
  const double longest = std::max({size.x, size.y, size.z});
  const double scale = longest > 0 ? double(0x1fffff) / longest : 0.0;

  std::vector<SortKey> keys(faces.size());
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const auto points = corners(soup, faces[i]);
    const glm::dvec3 centroid =
        (glm::dvec3(points[0]) + glm::dvec3(points[1]) + glm::dvec3(points[2])) / 3.0;
    const glm::dvec3 cell = (centroid - glm::dvec3(box.low)) * scale;
    keys[i] = {spread_bits(std::uint64_t(cell.x)) | spread_bits(std::uint64_t(cell.y)) << 1 |
                   spread_bits(std::uint64_t(cell.z)) << 2,
               hash_of(points), faces[i]};
  }
  std::sort(keys.begin(), keys.end(), [](const SortKey& a, const SortKey& b) {
    if (a.curve != b.curve) return a.curve < b.curve;
    if (a.hash != b.hash) return a.hash < b.hash;
    return a.face < b.face;
  });
  for (std::size_t i = 0; i < faces.size(); ++i) faces[i] = keys[i].face;
}

bool coincident(const TriangleSoup& soup, std::uint32_t a, std::uint32_t b) {
  const auto points_a = corners(soup, a), points_b = corners(soup, b);
  // Compares bits, since only equal bits give the rasteriser the same triangle.
  // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison)
  return std::memcmp(points_a.data(), points_b.data(), sizeof points_a) == 0;
}

void append_clusters(const TriangleSoup& soup, std::span<const std::uint32_t> faces,
                     std::uint32_t first, std::uint32_t last, std::uint32_t size,
                     std::vector<Cluster>& clusters) {
  while (first < last) {
    std::uint32_t end = std::min(first + size, last);
    while (end < last && coincident(soup, faces[end - 1], faces[end])) ++end;
    glm::dvec3 low(INFINITY), high(-INFINITY);
    for (std::uint32_t slot = first; slot < end; ++slot)
      for (const glm::vec3& p : corners(soup, faces[slot])) {
        low = glm::min(low, glm::dvec3(p));
        high = glm::max(high, glm::dvec3(p));
      }
    clusters.push_back({first, end - first, glm::vec3(0.5 * (low + high))});
    first = end;
  }
}

void FrontToBack::sort(std::span<const Cluster> clusters, glm::vec3 eye, glm::vec3 forward) {
  keys_.resize(clusters.size());
  for (std::uint32_t i = 0; i < clusters.size(); ++i) {
    const float depth = glm::dot(clusters[i].center - eye, forward);
    // Coordinates near the limit of float can give NaN, which has no order.
    keys_[i] = {std::isnan(depth) ? 0.0f : depth, i};
  }
  std::sort(keys_.begin(), keys_.end(), [](const Key& a, const Key& b) {
    return a.depth < b.depth || (a.depth == b.depth && a.cluster < b.cluster);
  });
  first_vertices_.resize(clusters.size());
  vertex_counts_.resize(clusters.size());
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    const Cluster& cluster = clusters[keys_[i].cluster];
    first_vertices_[i] = static_cast<std::int32_t>(3 * cluster.first_slot);
    vertex_counts_[i] = static_cast<std::int32_t>(3 * cluster.slot_count);
  }
}

}  // namespace tureen
