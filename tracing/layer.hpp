// One layer in the tree: its boxes, and its primitives in blocks for vectors.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <span>
#include <vector>

#include "scene/scene.hpp"
#include "tracing/bvh/bvh.hpp"
#include "tracing/ray.hpp"

namespace tureen::tracing {

struct RayKernel;

/// The tree stands in the layer's own coordinates: when the layer moves, it stays as it is, and it
/// loses no digits far from the world's origin.
class TracedLayer {
 public:
  /// `primitives` has no defect() and outlives the object. `index`: of the layer in its scene;
  /// `first`: the number of splats of the layers before.
  TracedLayer(const Primitives& primitives, const glm::dmat4& world_from_layer, std::uint32_t index,
              std::uint32_t first, const Parallel& parallel);

  /// Gives it another place, in the world and in its scene.
  void move(const glm::dmat4& world_from_layer, std::uint32_t index, std::uint32_t first);
  /// Whether refit() accepts these primitives: they have the same kernel and number.
  bool can_refit(const Primitives& primitives) const;
  /// Refits the tree to primitives that have moved or changed their sizes, or builds a new one if
  /// it has degraded. They outlive the object.
  void refit(const Primitives& primitives, const Parallel& parallel);
  /// Whether the last refit() built a new tree.
  bool was_rebuilt() const { return was_rebuilt_; }

  const Primitives& primitives() const { return *primitives_; }
  const RayKernel& kernel() const { return *kernel_; }
  const Bvh& bvh() const { return bvh_; }
  std::uint32_t index() const { return index_; }
  std::uint32_t first() const { return first_; }
  /// Block `leaf`: RayKernel::rows rows of `width` floats.
  const float* block(std::uint32_t leaf) const;
  /// The primitive in a lane of the blocks.
  std::uint32_t primitive(std::uint32_t lane) const { return bvh_.items()[lane]; }

  /// The ray up to `end`, a distance in world units.
  RayInLayer in_layer(const Ray& ray, double end) const;
  glm::dvec3 to_world(const glm::dvec3& direction) const { return world_from_layer_ * direction; }
  glm::dvec3 point_in_world(const glm::dvec3& point) const { return to_world(point) + origin_; }
  /// World units per layer unit.
  double scale() const { return scale_; }
  const glm::dmat3& world_from_layer() const { return world_from_layer_; }
  /// A point of the world in layer coordinates.
  glm::dvec3 point_in_layer(const glm::dvec3& point) const;

 private:
  void build(const Parallel& parallel);
  void pack(const Parallel& parallel);
  /// Whether rays could now see a primitive that is in no leaf.
  bool has_appeared() const;

  struct alignas(32) Line {
    float values[width];
  };
  const Primitives* primitives_;
  const RayKernel* kernel_;
  std::uint32_t index_ = 0, first_ = 0;
  glm::dmat3 world_from_layer_{1.0}, layer_from_world_{1.0};  // without the translation
  glm::dvec3 origin_{0.0};
  double scale_ = 1;
  Bvh bvh_;
  std::vector<Line> blocks_;
  std::vector<Box> leaf_boxes_;
  std::vector<std::uint32_t> hidden_;  // primitives that no ray can see
  bool was_rebuilt_ = false;
};

}  // namespace tureen::tracing
