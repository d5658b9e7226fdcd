// Building by the surface area heuristic (Goldsmith and Salmon, 1987) in bins (Wald, 2007), and
// refitting.
#include "tracing/bvh/bvh.hpp"

#include <algorithm>
#include <array>

namespace tureen::tracing {

namespace {

struct Item {
  Box box;
  std::uint32_t index;

  float center(int axis) const { return box.low[axis] + box.high[axis]; }  // twice
};

using Range = std::span<Item>;

constexpr int bins = 16;
/// A set of up to this many items is sorted instead of binned, and cut after full leaves only:
/// leaves that are a quarter full make rays 1.6 times slower.
constexpr std::size_t sorted_items = width * width;
/// Below this depth sets are cut in half: adversarial boxes would otherwise overflow the stack of a
/// traversal.
constexpr int halved_depth = 24;

Box box_of(Range range) {
  Box box;
  for (const Item& item : range) box.add(item.box);
  return box;
}

void set_child(Node& node, std::size_t slot, const Box& box) {
  for (int axis = 0; axis < 3; ++axis) {
    node.low[axis][slot] = box.low[axis];
    node.high[axis][slot] = box.high[axis];
  }
}

void sort_along(Range range, int axis) {
  std::sort(range.begin(), range.end(), [&](const Item& a, const Item& b) {
    // The index makes the order independent of the library's sort.
    return a.center(axis) != b.center(axis) ? a.center(axis) < b.center(axis) : a.index < b.index;
  });
}

/// The size of the first part of the best cut of a few items after full leaves; sorts them.
std::size_t cut_sorted(Range range) {
  float best = std::numeric_limits<float>::infinity();
  int best_axis = 0;
  std::size_t best_size = (range.size() / 2 + width - 1) / width * width;
  std::array<float, sorted_items> behind;  // the areas of the parts from an item on
  for (int axis = 0; axis < 3; ++axis) {
    sort_along(range, axis);
    Box box;
    for (std::size_t i = range.size(); i-- > 0;) {
      box.add(range[i].box);
      behind[i] = box.half_area();
    }
    box = {};
    for (std::size_t i = 0; i < range.size(); ++i) {
      if (i > 0 && i % width == 0) {
        const auto leaves = [](std::size_t count) { return float((count + width - 1) / width); };
        const float cost = box.half_area() * leaves(i) + behind[i] * leaves(range.size() - i);
        if (cost < best) best = cost, best_axis = axis, best_size = i;
      }
      box.add(range[i].box);
    }
  }
  if (best_axis != 2) sort_along(range, best_axis);
  return best_size;
}

/// The size of the first part in the middle of the widest axis; partitions the items.
std::size_t halve(Range range, const Box& centers) {
  const glm::vec3 size = centers.high - centers.low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const auto middle = range.begin() + std::ptrdiff_t(range.size() / 2);
  std::nth_element(range.begin(), middle, range.end(), [&](const Item& a, const Item& b) {
    return a.center(axis) != b.center(axis) ? a.center(axis) < b.center(axis) : a.index < b.index;
  });
  return range.size() / 2;
}

/// The size of the first part of a good cut; partitions the items. Both parts have items.
std::size_t cut(Range range, int depth) {
  if (range.size() <= sorted_items) return cut_sorted(range);
  Box centers;
  for (const Item& item : range) centers.add(item.box.low + item.box.high);
  if (depth > halved_depth) return halve(range, centers);

  struct Bin {
    Box box;
    std::size_t count = 0;
  };
  std::array<std::array<Bin, bins>, 3> of_axis;
  const glm::vec3 size = centers.high - centers.low;
  glm::vec3 scale;
  for (int axis = 0; axis < 3; ++axis)
    scale[axis] = size[axis] > 0 ? float(bins) * (1 - 1e-6f) / size[axis] : 0.0f;
  const auto bin_of = [&](const Item& item, int axis) {
    return std::min(int((item.center(axis) - centers.low[axis]) * scale[axis]), bins - 1);
  };
  for (const Item& item : range)
    for (int axis = 0; axis < 3; ++axis) {
      Bin& bin = of_axis[std::size_t(axis)][std::size_t(bin_of(item, axis))];
      bin.box.add(item.box);
      ++bin.count;
    }
  float best = std::numeric_limits<float>::infinity();
  int best_axis = -1, best_bin = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto& own = of_axis[std::size_t(axis)];
    std::array<float, bins> behind{};  // the cost of the bins from one on
    Box box;
    std::size_t count = 0;
    for (std::size_t i = bins; i-- > 1;) {
      box.add(own[i].box);
      count += own[i].count;
      behind[i] = box.half_area() * float(count);
    }
    box = {};
    count = 0;
    for (std::size_t i = 1; i < bins; ++i) {
      box.add(own[i - 1].box);
      count += own[i - 1].count;
      const float cost = box.half_area() * float(count) + behind[i];
      if (count > 0 && count < range.size() && cost < best)
        best = cost, best_axis = axis, best_bin = int(i);
    }
  }
  // All centres coincide, or the areas overflow.
  if (best_axis < 0) return halve(range, centers);
  const auto end = std::partition(range.begin(), range.end(), [&](const Item& item) {
    return bin_of(item, best_axis) < best_bin;
  });
  return std::size_t(end - range.begin());
}

}  // namespace

/// Builds a tree, or a part of one, with indices from 0.
class Builder {
 public:
  std::vector<Node> nodes;
  std::vector<std::uint32_t> items;

  struct Part {
    Range range;
    std::uint32_t parent;
    std::size_t slot;
    int depth;
  };
  /// Adds the node of these items and, unless they are few enough to be a part for another thread,
  /// those below.
  std::uint32_t add(Range all, int depth, std::size_t part_size, std::vector<Part>& parts) {
    std::array<Range, width> ranges;
    std::array<Box, width> boxes;
    ranges[0] = all;
    boxes[0] = box_of(all);
    std::size_t count = all.empty() ? 0 : 1;
    while (count > 0 && count < width) {
      std::size_t largest = width;
      for (std::size_t i = 0; i < count; ++i)
        if (ranges[i].size() > width &&
            (largest == width || boxes[i].half_area() > boxes[largest].half_area()))
          largest = i;
      if (largest == width) break;
      const Range range = ranges[largest];
      const std::size_t first = cut(range, depth);
      ranges[largest] = range.first(first);
      ranges[count] = range.subspan(first);
      for (const std::size_t i : {largest, count}) boxes[i] = box_of(ranges[i]);
      ++count;
    }
    const auto index = std::uint32_t(nodes.size());
    nodes.emplace_back();
    nodes[index].count = std::uint32_t(count);
    for (std::size_t i = 0; i < count; ++i) {
      set_child(nodes[index], i, boxes[i]);
      if (ranges[i].size() <= width)
        nodes[index].child[i] = Node::leaf_bit | add_leaf(ranges[i]);
      else if (ranges[i].size() <= part_size)
        parts.push_back({ranges[i], index, i, depth + 1});
      else {
        const std::uint32_t child = add(ranges[i], depth + 1, part_size, parts);
        nodes[index].child[i] = child;
      }
    }
    return index;
  }

  /// Adds another builder's tree below `part`.
  void append(const Part& part, const Builder& other) {
    const auto first_node = std::uint32_t(nodes.size());
    const auto first_leaf = std::uint32_t(items.size() / width);
    nodes[part.parent].child[part.slot] = first_node;
    for (Node node : other.nodes) {
      for (std::uint32_t i = 0; i < node.count; ++i)
        node.child[i] += node.child[i] & Node::leaf_bit ? first_leaf : first_node;
      nodes.push_back(node);
    }
    items.insert(items.end(), other.items.begin(), other.items.end());
  }

  Bvh finished() && {
    Bvh result;
    result.nodes_ = std::move(nodes);
    result.items_ = std::move(items);
    result.measure();
    result.built_area_ = result.area_;
    return result;
  }

 private:
  std::uint32_t add_leaf(Range range) {
    const auto leaf = std::uint32_t(items.size() / width);
    for (std::size_t i = 0; i < width; ++i)
      items.push_back(i < range.size() ? range[i].index : Bvh::no_item);
    return leaf;
  }
};

Bvh Bvh::over(std::span<const Box> boxes, const Parallel& parallel) {
  std::vector<Item> all;
  all.reserve(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i)
    if (boxes[i].is_usable()) all.push_back({boxes[i], std::uint32_t(i)});
  Builder top;
  std::vector<Builder::Part> parts;
  // Parts do not depend on the number of threads. At least 32 keep many of them busy.
  top.add(all, 0, std::max<std::size_t>(all.size() / 32, 4096), parts);
  std::vector<Builder> below(parts.size());
  parallel(parts.size(), [&](std::size_t i) {
    std::vector<Builder::Part> none;
    below[i].add(parts[i].range, parts[i].depth, 0, none);
  });
  for (std::size_t i = 0; i < parts.size(); ++i) top.append(parts[i], below[i]);
  return std::move(top).finished();
}

void Bvh::measure() {
  area_ = 0;
  box_ = {};
  for (const Node& node : nodes_)
    for (std::uint32_t i = 0; i < node.count; ++i) {
      const Box child{{node.low[0][i], node.low[1][i], node.low[2][i]},
                      {node.high[0][i], node.high[1][i], node.high[2][i]}};
      if (!child.is_usable()) continue;
      area_ += double(child.half_area());
      if (&node == nodes_.data()) box_.add(child);
    }
}

void Bvh::refit(std::span<const Box> of_leaves) {
  std::vector<Box> of_nodes(nodes_.size());
  for (std::size_t n = nodes_.size(); n-- > 0;) {
    Node& node = nodes_[n];
    for (std::uint32_t i = 0; i < node.count; ++i) {
      const std::uint32_t child = node.child[i];
      Box box = child & Node::leaf_bit ? of_leaves[child & ~Node::leaf_bit] : of_nodes[child];
      if (box.is_usable())
        of_nodes[n].add(box);
      else  // beyond all that rays meet: the infinities of an empty box would give NaN on a ray
        box = {glm::vec3(1e18f), glm::vec3(1e18f)};
      set_child(node, i, box);
    }
  }
  measure();
}

}  // namespace tureen::tracing
