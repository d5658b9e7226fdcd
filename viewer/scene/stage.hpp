// A document on the device. The worker prepares it, the main thread uses it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "jobs/baseline/baseline.hpp"
#include "runtime/debug_views/debug_views.hpp"
#include "runtime/renderer.hpp"
#include "viewer/scene/scene_source.hpp"

namespace tureen::viewer {

/// The user's drawing options: the pipeline, the preferences of the plan, and the quality.
struct DrawingChoice {
  PipelineKind pipeline = PipelineKind::tureen;
  PlanPreferences plan = {};
  std::optional<Quality> quality = {};  // default: the scene's own
};

Quality quality_of(const DrawingChoice& choice, const Scene& scene);

/// The choice as options of the runtime.
RenderOptions render_options(const DrawingChoice& choice, const Scene& scene);

/// A layer that the device refused.
struct RefusedLayer {
  DocumentLayer layer;
  std::uint64_t forecast_bytes = 0;  // of its buffers and textures
  std::string reason;                // the device's
};

/// "Forecast: 512.0 MiB. .."
std::string describe(const RefusedLayer& layer);

struct Stage {
  DrawingChoice choice;
  /// If the renderer was prepared for debug views; otherwise it was prepared by the choice. There
  /// is one renderer for both, so that the device holds the scene once, or twice while another
  /// stage is prepared.
  std::optional<DebugViews> debug_views;
  Renderer renderer;
  std::vector<DocumentLayer> layers;  // as the device has them, in its order
  double prepare_seconds = 0;
  std::vector<RefusedLayer> refused = {};

  /// Whether add_to() accepts this stage.
  bool can_grow() const { return !debug_views && choice.pipeline == PipelineKind::tureen; }
};

/// The inputs of preparation. `context` describes the device; a context that shares with it must be
/// current.
struct StageRequest {
  const gl::Context& context;
  DrawingChoice choice;
  std::function<void(double)> progress;  // 0..1; may throw to abandon
};

/// A renderer of the scene by the choice, in the current context. Throws DeviceLimitError and
/// UsageError.
Renderer prepare_renderer(const SceneSource& scene, const StageRequest& request);

/// Prepares a scene that was read, without the layers that the device refuses. The renderer has
/// left the context, so that the drawing thread can use it. Throws DeviceLimitError if it refuses
/// all, and UsageError.
std::unique_ptr<Stage> prepare_stage(const SceneSource& source, const StageRequest& request);

/// The same for debug views. Throws DeviceLimitError if the device refuses a layer.
std::unique_ptr<Stage> prepare_debug_stage(const SceneSource& source, const StageRequest& request);

/// Layers on the device, to be added to a stage that is shown.
struct StageAddition {
  std::vector<DocumentLayer> layers = {};
  std::vector<Renderer> renderers = {};  // for each of them; they have left their context
  std::vector<RefusedLayer> refused = {};
};

/// Uploads layers. `scene`: the source's. Throws UsageError.
StageAddition prepare_addition(const std::vector<DocumentLayer>& layers, const Scene& scene,
                               const StageRequest& request);

/// Adds the layers after those of the stage. What is on the device stays there. Needs
/// Stage::can_grow().
void add_to(Stage& stage, StageAddition addition);

/// Removes, orders, places and shows the layers on the device as the document has them, without
/// uploading. Returns the layers that have to be uploaded: new ones, and those with other
/// primitives than on the device, except those that the device refused.
std::vector<DocumentLayer> sync(Stage& stage, const Document& document);

}  // namespace tureen::viewer
