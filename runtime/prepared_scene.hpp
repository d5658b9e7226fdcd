// The data that a renderer needs from a scene, prepared without a device: the plan, and functions
// that produce the device's data block by block. Preparation may run on another thread or in
// another process (web/engine/prepared_archive.hpp). The Renderer is then created where the context
// is current.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "runtime/gl/context.hpp"
#include "runtime/passes/appearance_source.hpp"
#include "runtime/passes/geometry_source.hpp"
#include "runtime/passes/pass.hpp"
#include "runtime/plan/plan.hpp"
#include "runtime/render_options.hpp"
#include "runtime/splats/splat_source.hpp"
#include "scene/placed_layer.hpp"
#include "splatting/layer.hpp"

namespace tureen {

/// A soup before a device exists.
struct PreparedSoup {
  AppearanceSource appearance;
  GeometrySource geometry;
};

struct PreparedLayer {
  LayerPlace place = {};
  Bounds framed = {};  // framed_bounds()
  /// One of the three is set: `splats` for the device, `tiled_splats` for TilePass. All are empty
  /// if the passes from PreparedScene::make_passes hold the layer (the baselines).
  std::optional<PreparedSoup> soup = {};
  std::optional<SplatSource> splats = {};
  std::optional<splatting::LayerData> tiled_splats = {};
};

/// Makes all passes of a frame in the current context; the plan outlives them. May throw
/// DeviceLimitError.
using MakePasses = std::function<Passes(const gl::Capabilities&, const RenderPlan&)>;

struct PreparedScene {
  RenderPlan plan;
  std::vector<PreparedLayer> layers;  // one for each of plan.layers
  MakePasses make_passes = {};        // optional; the renderer then makes no passes for the layers
};

/// Plans for options.limits if it is set, otherwise for the device's limits. The sources read the
/// primitives, which must not move until the sources have been used, and must have no defect().
/// Throws UsageError as make_plan does. Throws DeviceLimitError with the needed memory if a layer
/// does not fit.
PreparedScene prepare_scene(std::span<const PlacedLayer> layers, const DeviceLimits& device,
                            const RenderOptions& options = {});
/// Prepares all layers of a scene, or a single soup.
PreparedScene prepare_scene(const Scene& scene, const DeviceLimits& device,
                            const RenderOptions& options = {});
PreparedScene prepare_scene(const TriangleSoup& soup, glm::dvec3 origin, const DeviceLimits& device,
                            const RenderOptions& options = {});
/// Prepares with a plan that make_plan made for these layers and limits.
PreparedScene prepare_scene(std::span<const PlacedLayer> layers, const DeviceLimits& limits,
                            RenderPlan plan);

}  // namespace tureen
