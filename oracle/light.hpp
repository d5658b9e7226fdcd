// Light along rays with mirrors and glass, in double precision, without a tree: the reference for
// tracing/. Rays off the image by oracle/splats_on_ray.hpp and oracle/shade.hpp, with eye_of() for
// all harmonics. A mirror's light is the reflected ray's times the base colour;
// of glass, by Fresnel's equations, the reflected ray's, and the refracted one's times the base
// colour. A ray that counts less than 1/510, or after more than 8 reflections and refractions, has
// the colour of the background.
#pragma once

#include <glm/mat4x4.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "image/image.hpp"
#include "oracle/splats_on_ray.hpp"
#include "scene/frame_input.hpp"
#include "scene/scene.hpp"

namespace tureen::oracle {

class Light {
 public:
  /// The visible layers of `scene`, which outlives the object and has no defect.
  Light(const Scene& scene, const glm::vec3& background);

  /// Along a ray in world coordinates, off the image from its origin on.
  glm::dvec3 along(const LightRay& ray) const { return along(ray, {}, 1, 0); }

  /// The image of a camera: its own rays blend splats as the rasteriser does, in
  /// SplatOrder::exact, over the light of the nearest surface. One ray a pixel.
  ImageF image(const FrameInput& input) const;

 private:
  struct Face {
    std::size_t layer, face;
    bool operator==(const Face&) const = default;
  };
  struct Surface {
    Face face{~std::size_t(0), 0};
    double b0 = 0, b1 = 0;
    double distance = std::numeric_limits<double>::infinity();
  };
  struct Own {  // a layer
    glm::dmat3 layer_from_world{1.0};
    double scale = 1;
    std::optional<SplatsOnRays> splats;
  };
  LightRay in_layer(const LightRay& ray, std::size_t layer) const;
  Surface nearest(const LightRay& ray, const Face& from) const;
  glm::dvec3 along(const LightRay& ray, const std::optional<Face>& from, double weight,
                   int depth) const;
  glm::dvec3 of(const Surface& surface, const LightRay& ray, double weight, int depth) const;

  const Scene& scene_;
  glm::dvec3 background_;
  std::vector<Own> layers_;
};

}  // namespace tureen::oracle
