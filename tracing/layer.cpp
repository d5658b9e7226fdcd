#include "tracing/layer.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "tracing/kernels/ray_kernel.hpp"

namespace tureen::tracing {

namespace {

/// Leaves that one call of a thread packs.
constexpr std::size_t leaves_a_task = 1024;
/// Distances to planes of boxes are rounded by 2^-24 of a coordinate of the origin, and by as much
/// of the difference, each in three operations: twice that.
constexpr double box_rounding = 6 * 0x1p-23;
/// A point of a face is rounded in about ten operations in double precision, on its way to the
/// world and back: 2^-49, and 8 times as much for faces that the ray leaves at a small angle.
constexpr double coordinate_rounding = 0x1p-46;

}  // namespace

TracedLayer::TracedLayer(const Primitives& primitives, const glm::dmat4& world_from_layer,
                         std::uint32_t index, std::uint32_t first, const Parallel& parallel)
    : primitives_(&primitives), kernel_(&ray_kernel_of(primitives)) {
  move(world_from_layer, index, first);
  build(parallel);
}

void TracedLayer::move(const glm::dmat4& world_from_layer, std::uint32_t index,
                       std::uint32_t first) {
  index_ = index;
  first_ = first;
  world_from_layer_ = glm::dmat3(world_from_layer);
  layer_from_world_ = glm::inverse(world_from_layer_);
  origin_ = glm::dvec3(world_from_layer[3]);
  scale_ = std::cbrt(std::abs(glm::determinant(world_from_layer_)));
}

void TracedLayer::build(const Parallel& parallel) {
  std::vector<Box> boxes(kernel_->count(*primitives_));
  const std::size_t a_task = leaves_a_task * width;
  parallel((boxes.size() + a_task - 1) / a_task, [&](std::size_t task) {
    std::vector<float> lane(width * kernel_->rows);
    for (std::size_t i = task * a_task; i < std::min((task + 1) * a_task, boxes.size()); ++i) {
      kernel_->pack(*primitives_, i, lane.data());
      boxes[i] = kernel_->box(*primitives_, lane.data());
    }
  });
  hidden_.clear();
  for (std::size_t i = 0; i < boxes.size(); ++i)
    if (!boxes[i].is_usable()) hidden_.push_back(std::uint32_t(i));
  bvh_ = Bvh::over(boxes, parallel);
  pack(parallel);
}

bool TracedLayer::has_appeared() const {
  std::vector<float> lane(width * kernel_->rows);
  return std::any_of(hidden_.begin(), hidden_.end(), [&](std::uint32_t i) {
    kernel_->pack(*primitives_, i, lane.data());
    return kernel_->box(*primitives_, lane.data()).is_usable();
  });
}

void TracedLayer::pack(const Parallel& parallel) {
  blocks_.resize(bvh_.leaves() * kernel_->rows);
  leaf_boxes_.assign(bvh_.leaves(), {});
  parallel((bvh_.leaves() + leaves_a_task - 1) / leaves_a_task, [&](std::size_t task) {
    const std::size_t end = std::min((task + 1) * leaves_a_task, bvh_.leaves());
    for (std::size_t leaf = task * leaves_a_task; leaf < end; ++leaf) {
      Line* lines = &blocks_[leaf * kernel_->rows];
      for (std::size_t i = 0; i < width; ++i) {
        float* lane = lines->values + i;
        const std::uint32_t item = bvh_.items()[leaf * width + i];
        if (item == Bvh::no_item) {
          for (std::size_t row = 0; row < kernel_->rows; ++row) lane[width * row] = kernel_->unused;
          continue;
        }
        kernel_->pack(*primitives_, item, lane);
        const Box box = kernel_->box(*primitives_, lane);
        if (box.is_usable()) leaf_boxes_[leaf].add(box);
      }
    }
  });
}

bool TracedLayer::can_refit(const Primitives& primitives) const {
  return kernel_ == &ray_kernel_of(primitives) &&
         kernel_->count(primitives) == kernel_->count(*primitives_);
}

void TracedLayer::refit(const Primitives& primitives, const Parallel& parallel) {
  primitives_ = &primitives;
  was_rebuilt_ = false;
  pack(parallel);
  bvh_.refit(leaf_boxes_);
  if (!bvh_.has_degraded() && !has_appeared()) return;
  build(parallel);
  was_rebuilt_ = true;
}

const float* TracedLayer::block(std::uint32_t leaf) const {
  return blocks_[leaf * kernel_->rows].values;
}

glm::dvec3 TracedLayer::point_in_layer(const glm::dvec3& point) const {
  return layer_from_world_ * (point - origin_);
}

RayInLayer TracedLayer::in_layer(const Ray& ray, double end) const {
  RayInLayer result;
  result.origin = point_in_layer(ray.origin);
  result.direction = glm::normalize(layer_from_world_ * ray.direction);
  result.eye = result.origin - ray.path / scale_ * result.direction;
  double largest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    result.high[axis] = float(result.origin[axis]);
    result.low[axis] = float(result.origin[axis] - double(result.high[axis]));
    result.along[axis] = float(result.direction[axis]);
    // The products with distances stay finite: 1e18 times 1e18.
    const float least = std::copysign(1e-18f, result.along[axis]);
    result.inverse[axis] = 1 / (std::abs(result.along[axis]) > 1e-18f ? result.along[axis] : least);
    largest = std::max(largest, std::abs(result.origin[axis]));
  }
  result.scale = float(scale_);
  result.path = float(ray.path / scale_);
  result.pixel = float(ray.pixel);
  const double footprint = double(kernel_->footprint(*primitives_)) * ray.pixel;
  result.grow = float(footprint * ray.path / scale_ + box_rounding * largest);
  result.grow_by_distance = float(footprint + box_rounding);
  result.end = float(end / scale_);
  const auto largest_of = [](const glm::dvec3& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  };
  result.least =
      coordinate_rounding * (largest + (largest_of(ray.origin) + largest_of(origin_)) / scale_);
  return result;
}

}  // namespace tureen::tracing
