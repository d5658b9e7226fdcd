// The oracle: the slow, simple reference renderer for all other paths, in double precision, without
// GL. It draws the nearest visible hit along each pixel's ray. At equal depth, the earlier layer
// wins; within a layer, the face with the lower index. GL_LESS gives the same result if layers and
// faces are drawn in order. Splats in front of this hit are blended over it (oracle/splats.hpp).
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "image/image.hpp"
#include "oracle/hits.hpp"
#include "oracle/splats.hpp"
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
  oracle::SplatOrder splat_order = oracle::SplatOrder::center;
  /// Whether a splat that would lower the transmittance below its profile's stop_transmittance ends
  /// the pixel. If false, every splat is blended.
  bool splat_stop = true;
  /// Whether splats are also culled as their authors' code culls them.
  oracle::SplatCulls splat_culls = oracle::SplatCulls::none;
  /// The colour behind the scene; alpha is then 1. If absent, alpha is the mean coverage of the
  /// pixel's rays, and the colour is that of the covered part. The coverage of a ray is 1 if it
  /// hits a face, otherwise the alpha of its splats. A pixel with coverage 0 is 0 in all channels.
  std::optional<glm::vec3> background = glm::vec3(0.0f);
  /// Called with the fraction done, 0..1; may throw to cancel.
  std::function<void(double)> progress = {};
};

struct OracleImage {
  static constexpr std::uint32_t no_face = tureen::no_face;

  /// Clamped to [0, 1] once, after the mean over a pixel's rays: colours of splats may exceed 1.
  ImageF color;
  /// The visible face and its depth along each ray, row by row from the top. A row has width *
  /// supersampling rays.
  std::vector<std::uint32_t> face;
  std::vector<std::uint32_t> layer;  // of the face: index in Scene::layers; 0 without a face
  std::vector<double> depth;         // in world units; infinity without a face
  /// For each ray: one minus the transmittance of all splats in front of the face; 0 without
  /// splats. Empty if the scene has no visible layer of splats.
  std::vector<double> splat_alpha;
  /// For each ray: the depth of the splat at which the transmittance falls to 0.5 or below, in
  /// world units; infinity if it stays above. Where it is finite, a picked ray shows splats, and
  /// otherwise the face. Empty like splat_alpha.
  std::vector<double> splat_depth;
};

/// All visible layers of `scene`: neither they nor their primitives have a defect(). Each layer's
/// appearance is evaluated in its own coordinates. The near plane is that of clip_range() for these
/// layers and reversed depth.
OracleImage render_oracle(const Scene& scene, const FrameInput& input,
                          const OracleOptions& options = {});

/// A scene of this soup alone, at `origin` in world coordinates.
OracleImage render_oracle(const TriangleSoup& soup, glm::dvec3 origin, const FrameInput& input,
                          const OracleOptions& options = {});

}  // namespace tureen
