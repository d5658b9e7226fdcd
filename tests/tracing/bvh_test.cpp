// The tree over boxes.
#include "tracing/bvh/bvh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/threads/thread_pool.hpp"
#include "tests/tracing/tracing_scenes.hpp"

namespace tureen::test {
namespace bvh_test {

using tracing::Box;
using tracing::Bvh;
using tracing::Node;

std::vector<Box> random_boxes(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Box> boxes(count);
  for (Box& box : boxes) {
    const glm::vec3 center(random.direction() * std::cbrt(random.uniform()));
    const glm::vec3 size(0.01 * glm::dvec3(random.uniform(), random.uniform(), random.uniform()));
    box.add(center - size);
    box.add(center + size);
  }
  return boxes;
}

/// Checks the boxes of a node's children against those below. Returns the box of the node.
Box check(const Bvh& tree, const std::vector<Box>& boxes, std::uint32_t index,
          std::vector<int>& seen) {
  const Node& node = tree.nodes()[index];
  Box all;
  for (std::uint32_t i = 0; i < node.count; ++i) {
    Box box;
    const std::uint32_t child = node.child[i];
    if (child & Node::leaf_bit) {
      for (std::size_t lane = 0; lane < tracing::width; ++lane) {
        const std::uint32_t item = tree.items()[(child & ~Node::leaf_bit) * tracing::width + lane];
        if (item == Bvh::no_item) continue;
        ++seen[item];
        box.add(boxes[item]);
      }
    } else {
      EXPECT_GT(child, index) << "parents come before their children";
      box = check(tree, boxes, child, seen);
    }
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(node.low[axis][i], box.low[axis]);
      EXPECT_EQ(node.high[axis][i], box.high[axis]);
    }
    all.add(box);
  }
  return all;
}

TEST(Bvh, HasEveryItemOnceInTightBoxes) {
  for (const std::size_t count : {0u, 1u, 8u, 9u, 64u, 65u, 1000u, 30000u}) {
    const std::vector<Box> boxes = random_boxes(count, count);
    const Bvh tree = Bvh::over(boxes, in_order);
    std::vector<int> seen(count);
    check(tree, boxes, 0, seen);
    EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](int n) { return n == 1; })) << count;
    if (count < 1000) continue;
    // A quarter of the lanes makes rays 1.6 times slower than full leaves.
    EXPECT_LT(tree.leaves() * tracing::width, count * 5 / 4) << "leaves are nearly full";
  }
}

TEST(Bvh, CoincidentAndUnusableBoxes) {
  std::vector<Box> boxes(5000, Box{glm::vec3(1.0f), glm::vec3(2.0f)});
  boxes[7] = {};  // empty
  boxes[8] = {glm::vec3(NAN), glm::vec3(1.0f)};
  boxes[9] = {glm::vec3(-3e38f), glm::vec3(3e38f)};
  const Bvh tree = Bvh::over(boxes, in_order);
  std::vector<int> seen(boxes.size());
  check(tree, boxes, 0, seen);
  for (std::size_t i = 0; i < boxes.size(); ++i)
    EXPECT_EQ(seen[i], i == 7 || i == 8 || i == 9 ? 0 : 1) << i;
}

TEST(Bvh, ThreadsBuildTheSameTree) {
  const std::vector<Box> boxes = random_boxes(60000, 3);
  const Bvh one = Bvh::over(boxes, in_order);
  for (const int threads : {2, 3}) {
    ThreadPool pool(threads);
    const Bvh other =
        Bvh::over(boxes, [&](std::size_t count, const auto& body) { pool.run(count, body); });
    EXPECT_TRUE(std::ranges::equal(one.items(), other.items()));
    ASSERT_EQ(one.nodes().size(), other.nodes().size());
    for (std::size_t i = 0; i < one.nodes().size(); ++i)
      EXPECT_TRUE(std::ranges::equal(one.nodes()[i].child, other.nodes()[i].child));
  }
}

TEST(Bvh, DegradesWhenItsBoxesGrow) {
  const std::vector<Box> boxes = random_boxes(2000, 5);
  Bvh tree = Bvh::over(boxes, in_order);
  std::vector<Box> leaves(tree.leaves());
  const auto refit = [&](float scale) {
    for (std::size_t leaf = 0; leaf < leaves.size(); ++leaf) {
      leaves[leaf] = {};
      for (std::size_t lane = 0; lane < tracing::width; ++lane)
        if (const std::uint32_t item = tree.items()[leaf * tracing::width + lane];
            item != Bvh::no_item)
          leaves[leaf].add({boxes[item].low * scale, boxes[item].high * scale});
    }
    tree.refit(leaves);
  };
  refit(1.4f);  // surfaces 1.96 times as large
  EXPECT_FALSE(tree.has_degraded());
  refit(1.45f);  // 2.1
  EXPECT_TRUE(tree.has_degraded());
  refit(1.0f);
  EXPECT_FALSE(tree.has_degraded());
}

}  // namespace bvh_test
}  // namespace tureen::test
