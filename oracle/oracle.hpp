// The oracle: the slow, obvious renderer that every other path is measured against. Double
// precision, no GL. It draws the nearest visible hit along each pixel's ray; hits at exactly the
// same depth are won by the lower face, as GL_LESS has it for faces drawn in order.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "image/image.hpp"
#include "oracle/hits.hpp"
#include "scene/camera.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen {

struct OracleOptions {
  /// For holding GL against it, Coverage::snapped; for reports of error, Coverage::exact.
  oracle::RayOptions rays = {};
  /// Rays a pixel and axis: the pixel is the mean of supersampling^2 rays on a regular grid.
  int supersampling = 1;
  /// Shows where nothing is hit. Without one such pixels are transparent: the colour is that of the
  /// covered part alone and alpha is the coverage.
  std::optional<glm::vec3> background = glm::vec3(0.0f);
  /// Called with the fraction done, 0..1; may throw to abandon the image.
  std::function<void(double)> progress = {};
};

struct OracleImage {
  static constexpr std::uint32_t no_face = tureen::no_face;

  ImageF color;
  /// One a ray, (width * supersampling) a row, from the top: which face won, and how deep.
  std::vector<std::uint32_t> face;
  std::vector<double> depth;  // infinity where no face
};

/// `soup` has no defect(); `origin` is Scene::origin. The near plane is that of clip_range() for
/// reversed depth.
OracleImage render_oracle(const TriangleSoup& soup, glm::dvec3 origin, const Camera& camera,
                          const OracleOptions& options = {});

}  // namespace tureen
