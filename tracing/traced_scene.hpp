// A scene for rays of any origin: mirrors, glass, and what is seen in them.
//
// A ray blends the splats on it in their exact order up to the nearest surface, by the rules of
// tracing/kernels/ray_kernel.hpp, over the light of that surface:
//   mirror   the light along the reflected ray, times the base colour
//   glass    by Fresnel's equations, the sum of the light along the reflected ray and of the light
//            along the refracted ray times the base colour; normals point out of the glass, because
//            they decide on which side of a face there is air
//   others   the colour that every renderer draws
// Harmonics are functions of the direction from the ray's eye (RayInLayer::eye). A ray that would
// count less than 1/510 of the pixel, or that has been reflected or refracted more than 8 times,
// has the colour of the background.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "scene/document/document.hpp"
#include "tracing/layer.hpp"
#include "tracing/ray.hpp"

namespace tureen::tracing {

/// Reflections and refractions of a ray.
inline constexpr int max_depth = 8;
/// Half an 8-bit step.
inline constexpr double least_weight = 1.0 / 510;

struct BlendedSplats {
  glm::dvec3 color{0};  // premultiplied
  double transmittance = 1;
};

/// Memory of one thread between its rays. No result depends on it.
struct RayMemory {
  std::vector<RayInLayer> layers;
  std::vector<SplatOnRay> hits;
  /// By depth: the distance up to which the last ray's splats were collected.
  std::array<float, max_depth + 2> reach{};
};

/// The layers of a scene without their bounds. They refer to its primitives, which outlive them.
std::vector<DocumentLayer> layers_for_rays(const Scene& scene);

class TracedScene {
 public:
  /// Without layers.
  explicit TracedScene(const glm::vec3& background) : background_(background) {}
  /// The visible layers of `scene`, which outlives the object and has no defect.
  TracedScene(const Scene& scene, const glm::vec3& background, const Parallel& parallel);

  /// Shows these layers; they have no defect. Layers keep their tree by their id, also when they
  /// move, are hidden or get another material. It is refitted to other primitives of the same
  /// number and kernel. If `parallel` throws, complete trees stay for the next call, which must
  /// come before any other.
  void sync(const std::vector<DocumentLayer>& layers, const Parallel& parallel);

  /// A visible layer.
  const TracedLayer& layer(std::uint32_t index) const { return *shown_[index]; }
  bool has_surfaces() const { return !surfaces_.empty(); }
  /// The nearest visible point of a soup.
  SurfaceOnRay surface_on(const Ray& ray) const;
  /// The splats at distances below `end`.
  BlendedSplats splats_on(const Ray& ray, double end, RayMemory& memory, int depth = 0) const;
  /// The light that comes against the ray, which counts `weight` of the pixel.
  glm::dvec3 light_along(const Ray& ray, double weight, int depth, RayMemory& memory) const;
  /// The light that a surface sends against the ray.
  glm::dvec3 light_of(const SurfaceOnRay& surface, const Ray& ray, double weight, int depth,
                      RayMemory& memory) const;

 private:
  struct Tree {
    LayerId id;
    std::shared_ptr<const Primitives> primitives;
    std::unique_ptr<TracedLayer> layer;
  };
  TracedLayer& tree_of(const DocumentLayer& layer, const Parallel& parallel);
  glm::dvec3 light_of_glass(const SurfaceOnRay& surface, const Ray& ray, double weight, int depth,
                            RayMemory& memory) const;

  glm::dvec3 background_;
  std::vector<Tree> trees_;                // also of hidden layers
  std::vector<const TracedLayer*> shown_;  // by index in the scene; null: hidden
  std::vector<std::optional<Material>> materials_;
  std::vector<const TracedLayer*> surfaces_, splats_;
};

}  // namespace tureen::tracing
