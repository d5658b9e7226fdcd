#include "examples/ray_caster.hpp"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>

namespace tureen::example {
namespace {

constexpr std::uint32_t faces_per_leaf = 3;

glm::dvec3 center(const Face& face) {
  return (face.corners[0] + face.corners[1] + face.corners[2]) / 3.0;
}

struct Meeting {
  double distance, b1, b2;
};

/// The algorithm of Möller and Trumbore, for both sides.
std::optional<Meeting> meet(const Face& face, glm::dvec3 origin, glm::dvec3 direction) {
  const glm::dvec3 e1 = face.corners[1] - face.corners[0], e2 = face.corners[2] - face.corners[0];
  const glm::dvec3 p = glm::cross(direction, e2);
  const double determinant = glm::dot(e1, p);
  if (determinant == 0) return std::nullopt;
  const glm::dvec3 s = origin - face.corners[0];
  const double b1 = glm::dot(s, p) / determinant;
  if (b1 < 0 || b1 > 1) return std::nullopt;
  const glm::dvec3 q = glm::cross(s, e1);
  const double b2 = glm::dot(direction, q) / determinant;
  if (b2 < 0 || b1 + b2 > 1) return std::nullopt;
  return Meeting{glm::dot(e2, q) / determinant, b1, b2};
}

}  // namespace

RayCaster::RayCaster(const Model& model) : model_(model), faces_(model.faces.size()) {
  std::iota(faces_.begin(), faces_.end(), 0u);
  nodes_.emplace_back();
  build(0, 0, static_cast<std::uint32_t>(faces_.size()));
}

void RayCaster::build(std::uint32_t node, std::uint32_t begin, std::uint32_t end) {
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
  for (std::uint32_t i = begin; i < end; ++i)
    for (const glm::dvec3& corner : model_.faces[faces_[i]].corners) {
      low = glm::min(low, corner);
      high = glm::max(high, corner);
    }
  nodes_[node] = {low, high, begin, end - begin};
  if (end - begin <= faces_per_leaf) return;
  const glm::dvec3 extent = high - low;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(faces_.begin() + begin, faces_.begin() + middle, faces_.begin() + end,
                   [&](std::uint32_t a, std::uint32_t b) {
                     return center(model_.faces[a])[axis] < center(model_.faces[b])[axis];
                   });
  const auto children = static_cast<std::uint32_t>(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  nodes_[node].first = children;
  nodes_[node].count = 0;
  build(children, begin, middle);
  build(children + 1, middle, end);
}

std::optional<Hit> RayCaster::first_hit(glm::dvec3 origin, glm::dvec3 direction,
                                        double nearest) const {
  const glm::dvec3 inverse = 1.0 / direction;
  double best = std::numeric_limits<double>::infinity();
  std::optional<Hit> hit;
  const auto enters = [&](const Node& node) {
    const glm::dvec3 a = (node.low - origin) * inverse, b = (node.high - origin) * inverse;
    const glm::dvec3 in = glm::min(a, b), out = glm::max(a, b);
    const double from = std::max({in.x, in.y, in.z, nearest});
    const double to = std::min({out.x, out.y, out.z, best});
    return from <= to ? from : std::numeric_limits<double>::infinity();
  };
  std::array<std::uint32_t, 64> stack;  // with median splits, the depth is log2 of the faces
  int top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const Node& node = nodes_[stack[--top]];
    if (node.count == 0) {
      const double left = enters(nodes_[node.first]), right = enters(nodes_[node.first + 1]);
      const std::uint32_t near = left <= right ? node.first : node.first + 1;
      const std::uint32_t far = left <= right ? node.first + 1 : node.first;
      if (std::max(left, right) < best) stack[top++] = far;
      if (std::min(left, right) < best) stack[top++] = near;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      const Face& face = model_.faces[faces_[i]];
      const auto met = meet(face, origin, direction);
      if (!met || met->distance < nearest || met->distance >= best) continue;
      const glm::dvec2 uv =
          face.uv[0] * (1 - met->b1 - met->b2) + face.uv[1] * met->b1 + face.uv[2] * met->b2;
      if (model_.surfaces[face.surface].cut_out &&
          model_.paint(model_.point(face.surface, uv), face.surface).hole)
        continue;
      best = met->distance;
      hit = Hit{faces_[i], uv};
    }
  }
  return hit;
}

}  // namespace tureen::example
