// The draw order of faces: near ones first, so that hidden fragments fail the depth test before
// they cost a texture read; coincident ones by their index.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "scene/triangle_soup.hpp"

namespace tureen {

/// A run of consecutive slots that are drawn together. A slot is a position in the plan's list of
/// faces. The faces of a cluster lie close together.
struct Cluster {
  std::uint32_t first_slot = 0;
  std::uint32_t slot_count = 0;
  glm::vec3 center{0.0f};
};

/// Faces per cluster in a soup with `faces` faces. Sizes from 1 to 256 made little difference. The
/// chosen size is small enough for a good order. It limits a frame to a few thousand clusters, and
/// their sorting time is negligible.
constexpr std::uint32_t cluster_size(std::size_t faces) {
  return static_cast<std::uint32_t>(std::max<std::size_t>(64, faces / 4096));
}

/// Sorts `faces` (indices into soup.triangles) along a space-filling curve. Faces with
/// bit-identical corners in the same order become neighbours, the lower index first.
void sort_spatially(const TriangleSoup& soup, std::vector<std::uint32_t>& faces);

/// Whether two faces have bit-identical corners in the same order.
bool coincident(const TriangleSoup& soup, std::uint32_t a, std::uint32_t b);

/// Splits slots [first, last) into clusters. Coincident faces are always in the same cluster, so
/// that the lower index is drawn first.
void append_clusters(const TriangleSoup& soup, std::span<const std::uint32_t> faces,
                     std::uint32_t first, std::uint32_t last, std::uint32_t size,
                     std::vector<Cluster>& clusters);

/// Orders clusters front to back for a frame and returns the vertex ranges to draw.
class FrontToBack {
 public:
  /// Orders clusters [first, last) by the depth of their centres along `forward` from `eye`, both
  /// relative to the soup's origin. Ties keep their order.
  void sort(std::span<const Cluster> clusters, glm::vec3 eye, glm::vec3 forward);

  /// First vertex and number of vertices of each range, as glMultiDrawArrays needs them.
  std::span<const std::int32_t> first_vertices() const { return first_vertices_; }
  std::span<const std::int32_t> vertex_counts() const { return vertex_counts_; }

 private:
  struct Key {
    float depth;
    std::uint32_t cluster;
  };
  std::vector<Key> keys_;
  std::vector<std::int32_t> first_vertices_, vertex_counts_;
};

}  // namespace tureen
