// The data that a renderer needs from a scene, prepared without a device: the plan, and functions
// that produce the device's data block by block. Preparation may run on another thread or in
// another process (web/engine/prepared_archive.hpp). The Renderer is then created where the context
// is current.
#pragma once

#include <functional>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/passes/appearance_source.hpp"
#include "runtime/passes/device_soup.hpp"
#include "runtime/passes/geometry_source.hpp"
#include "runtime/passes/pass.hpp"
#include "runtime/plan/plan.hpp"
#include "runtime/render_options.hpp"
#include "runtime/splats/splat_source.hpp"
#include "scene/scene.hpp"
#include "splatting/layer.hpp"

namespace tureen {

/// A soup before a device exists.
struct PreparedSoup {
  AppearanceSource appearance;
  GeometrySource geometry;
};

struct PreparedLayer {
  std::string name = {};
  Bounds bounds = {};  // in layer coordinates
  Bounds framed = {};  // framed_bounds()
  glm::dmat4 world_from_layer{1.0};
  bool visible = true;
  /// One of the three is set: `splats` for the device, `tiled_splats` for TilePass. All are empty
  /// if the passes from PreparedScene::make_passes hold the layer (the baselines).
  std::optional<PreparedSoup> soup = {};
  std::optional<SplatSource> splats = {};
  std::optional<splatting::LayerData> tiled_splats = {};
};

/// The inputs of a function that makes passes.
struct PassInputs {
  const gl::Capabilities& device;
  const RenderPlan& plan;  // outlives the passes
  /// The prepared soups on the device, in order; they outlive the passes.
  std::span<const std::unique_ptr<DeviceSoup>> soups;
};

struct PreparedScene {
  RenderPlan plan;
  std::vector<PreparedLayer> layers;  // one for each of plan.layers
  /// Optional. Makes all passes of a frame in the current context; the renderer then makes none for
  /// the soups. May throw DeviceLimitError.
  std::function<Passes(const PassInputs&)> make_passes = {};
};

/// A soup with its place. It refers to the soup.
struct PlacedSoup {
  const TriangleSoup& soup;
  glm::dmat4 world_from_layer{1.0};
  std::string name = {};
  bool visible = true;
};
/// The layers of a scene that are soups.
std::vector<PlacedSoup> placed_soups(const Scene& scene);

/// The primitives of a layer with their place. It refers to the primitives.
struct PlacedLayer {
  const Primitives& primitives;
  glm::dmat4 world_from_layer{1.0};
  std::string name = {};
  bool visible = true;
};

/// The layers of a scene.
std::vector<PlacedLayer> placed_layers(const Scene& scene);
/// Those that are soups.
std::vector<PlacedSoup> placed_soups(std::span<const PlacedLayer> layers);

/// Plans for options.limits if it is set, otherwise for the device's limits. The sources read the
/// soups. The soups must not move until the sources have been used. Soups and layers must have no
/// defect(). Throws UsageError as make_plan does. Throws DeviceLimitError with the needed memory if
/// a soup does not fit.
PreparedScene prepare_scene(std::span<const PlacedSoup> layers, const DeviceLimits& device,
                            const RenderOptions& options = {});
/// The same for layers that may also be splats, for a scene, and for a single soup.
PreparedScene prepare_scene(std::span<const PlacedLayer> layers, const DeviceLimits& device,
                            const RenderOptions& options = {});
PreparedScene prepare_scene(const Scene& scene, const DeviceLimits& device,
                            const RenderOptions& options = {});
PreparedScene prepare_scene(const TriangleSoup& soup, glm::dvec3 origin, const DeviceLimits& device,
                            const RenderOptions& options = {});
/// The same with a plan from make_plan for these soups and limits.
PreparedScene prepare_scene(std::span<const PlacedSoup> layers, const DeviceLimits& limits,
                            RenderPlan plan);
/// Whether TilePass blends the splats, so the device does not hold them. Throws UsageError if
/// SplatBlending::tiles or the exact order is requested and tiles cannot blend the splats, for
/// raster with the exact order, and for tiles with stochastic splats.
bool uses_tiles(const Splats& splats, const SplatPlan& plan, const DeviceLimits& limits,
                const PlanPreferences& preferences);
/// Completes a scene that was prepared from the soups of `layers`. Of `preferences`, those of
/// splats are used. Throws UsageError as uses_tiles() does.
void add_splats(PreparedScene& prepared, std::span<const PlacedLayer> layers,
                const DeviceLimits& limits, const PlanPreferences& preferences);

}  // namespace tureen
