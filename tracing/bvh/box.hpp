// Boxes in the coordinates of a layer.
#pragma once

#include <glm/common.hpp>
#include <glm/vec3.hpp>
#include <limits>

namespace tureen::tracing {

/// `low` > `high`: empty.
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

}  // namespace tureen::tracing
