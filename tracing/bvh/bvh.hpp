// A bounding volume hierarchy with eight children a node and up to eight items a leaf. It has only
// boxes; the primitives stand in blocks of eight lanes, one block a leaf (tracing/layer.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <vector>

namespace tureen::tracing {

/// A box in the coordinates of a layer. `low` > `high`: empty.
struct Box {
  glm::vec3 low{std::numeric_limits<float>::infinity()};
  glm::vec3 high{-std::numeric_limits<float>::infinity()};

  void add(const glm::vec3& point) {
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
  void add(const Box& other) {
    low = glm::min(low, other.low);
    high = glm::max(high, other.high);
  }
  /// Whether rays can meet it: not empty, and small enough that no distance to it overflows.
  bool is_usable() const {
    const auto usable = [](float from, float to) {
      return from <= to && from > -1e18f && to < 1e18f;
    };
    return usable(low.x, high.x) && usable(low.y, high.y) && usable(low.z, high.z);
  }
  /// Half the surface area: proportional to the number of random rays that meet it.
  float half_area() const {
    if (!(low.x <= high.x)) return 0;
    const glm::vec3 size = high - low;
    return size.x * (size.y + size.z) + size.y * size.z;
  }
};

/// Calls body(0) .. body(count - 1), in any order, perhaps in several threads.
using Parallel =
    std::function<void(std::size_t count, const std::function<void(std::size_t)>& body)>;

inline constexpr std::size_t width = 8;  // children a node, and lanes a leaf

struct alignas(64) Node {
  /// The boxes of the first `count` children; the others are 0.
  float low[3][width] = {}, high[3][width] = {};
  /// The index of a node, or leaf_bit | the index of a leaf.
  std::uint32_t child[width] = {};
  std::uint32_t count = 0;

  static constexpr std::uint32_t leaf_bit = 0x80000000u;
};

class Bvh {
 public:
  static constexpr std::uint32_t no_item = 0xffffffffu;

  /// Over the items whose boxes are usable; others are in no leaf. The result does not depend on
  /// the number of threads.
  static Bvh over(std::span<const Box> boxes, const Parallel& parallel);

  /// The nodes, parents before their children; the root first. Without usable items there is one
  /// node without children.
  std::span<const Node> nodes() const { return nodes_; }
  /// The items of leaf i: [width * i, width * (i + 1)), with no_item in unused lanes.
  std::span<const std::uint32_t> items() const { return items_; }
  std::size_t leaves() const { return items_.size() / width; }
  /// Around all usable items.
  const Box& box() const { return box_; }

  /// New boxes of the leaves, after their items have moved. Boxes that are not usable hide their
  /// leaf.
  void refit(std::span<const Box> of_leaves);
  /// Whether the boxes have at least twice the surface that they had when the tree was built: then
  /// rays pass through so many that a new tree is faster (REdiSplats: rebuild at 2).
  bool has_degraded() const { return area_ > 2 * built_area_; }

 private:
  friend class Builder;
  void measure();

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> items_;
  Box box_;
  double area_ = 0, built_area_ = 0;  // the sum over all nodes' children
};

}  // namespace tureen::tracing
