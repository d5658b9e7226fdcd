// The oracle: the slow, simple reference renderer for all other paths, in double precision, without
// GL. It draws the nearest visible hit along each pixel's ray. At equal depth, the earlier layer
// wins; within a layer, the face with the lower index. GL_LESS gives the same result if layers and
// faces are drawn in order.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "image/image.hpp"
#include "oracle/hits.hpp"
#include "scene/frame_input.hpp"
#include "scene/scene.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen {

struct OracleOptions {
  /// Coverage::snapped reproduces GL's coverage; Coverage::exact uses unrounded triangles.
  oracle::RayOptions rays = {};
  /// Rays per pixel along each axis, default 1: the pixel is the mean of supersampling^2 rays on a
  /// regular grid.
  int supersampling = 1;
  /// The colour behind the hits; alpha is then 1. If absent, a pixel has the mean colour of its
  /// hits, and alpha is the fraction of its rays that hit; a pixel without a hit is 0 in all
  /// channels.
  std::optional<glm::vec3> background = glm::vec3(0.0f);
  /// Called with the fraction done, 0..1; may throw to cancel.
  std::function<void(double)> progress = {};
};

struct OracleImage {
  static constexpr std::uint32_t no_face = tureen::no_face;

  ImageF color;
  /// The visible face and its depth along each ray, row by row from the top. A row has width *
  /// supersampling rays.
  std::vector<std::uint32_t> face;
  std::vector<std::uint32_t> layer;  // of the face: index in Scene::layers; 0 without a face
  std::vector<double> depth;         // in world units; infinity without a face
};

/// All visible layers of `scene`. Each holds a TriangleSoup (see make_opaque); neither layers nor
/// soups have a defect(). Each soup's appearance is evaluated in its layer's coordinates. The near
/// plane is that of clip_range() for these layers and reversed depth.
OracleImage render_oracle(const Scene& scene, const FrameInput& input,
                          const OracleOptions& options = {});

/// A scene of this soup alone, at `origin` in world coordinates.
OracleImage render_oracle(const TriangleSoup& soup, glm::dvec3 origin, const FrameInput& input,
                          const OracleOptions& options = {});

}  // namespace tureen
