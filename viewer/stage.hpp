// A scene that is ready to draw: read, planned and on the device. The worker creates it, the main
// thread uses it.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "camera/navigation.hpp"
#include "camera/up_axis.hpp"
#include "jobs/baseline/baseline.hpp"
#include "runtime/debug_views/debug_views.hpp"
#include "runtime/renderer.hpp"
#include "scene/scene.hpp"
#include "viewer/files/file_watch.hpp"

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

/// A scene that was read.
struct StageSource {
  std::filesystem::path path;
  std::shared_ptr<const Scene> scene;  // its layers hold no soft triangles
  Subject subject;                     // with the guessed up axis
  UpGuess up;
  FileWatch watch;  // created before it was read
  double read_seconds = 0;

  const TriangleSoup& soup() const { return only_soup(*scene); }
  glm::dvec3 origin() const { return origin_of(only_layer(*scene)); }
};

struct Stage : StageSource {
  DrawingChoice choice;
  /// If the renderer was prepared for debug views; otherwise it was prepared by the choice. There
  /// is only one renderer, so that the device holds the scene once.
  std::optional<DebugViews> debug_views;
  Renderer renderer;
  double prepare_seconds = 0;

  const StageSource& source() const { return *this; }
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
Renderer prepare_renderer(const StageSource& scene, const StageRequest& request);

/// Reads a scene and prepares it. The renderer has left the context, so that the drawing thread can
/// use it. Throws InputError, DeviceLimitError and UsageError.
std::unique_ptr<Stage> read_stage(const std::filesystem::path& path, const StageRequest& request);

/// Prepares a scene that was read, for debug views, likewise.
std::unique_ptr<Stage> prepare_debug_stage(const StageSource& source, const StageRequest& request);

/// Prepares a scene that was read, likewise.
std::unique_ptr<Stage> prepare_stage(const StageSource& source, const StageRequest& request);

}  // namespace tureen::viewer
