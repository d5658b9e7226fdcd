// A scene that stands ready to be drawn: read, planned and on the device. Made by the worker, used
// by the main thread.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "camera/navigation.hpp"
#include "camera/up_axis.hpp"
#include "jobs/baseline/baseline.hpp"
#include "runtime/renderer.hpp"
#include "scene/scene.hpp"
#include "viewer/files/file_watch.hpp"

namespace tureen::viewer {

/// A person's choice of how to draw: the pipeline, the specialisations that a plan may apply, and
/// the quality.
struct DrawingChoice {
  PipelineKind pipeline = PipelineKind::tureen;
  PlanPreferences plan = {};
  std::optional<Quality> quality = {};  // the scene's own unless it is chosen
};

Quality quality_of(const DrawingChoice& choice, const Scene& scene);

/// The choice as the runtime takes it.
RenderOptions render_options(const DrawingChoice& choice, const Scene& scene);

/// What was read.
struct StageSource {
  std::filesystem::path path;
  std::shared_ptr<const Scene> scene;  // its primitives are a TriangleSoup
  Subject subject;                     // with the guessed up axis
  UpGuess up;
  FileWatch watch;  // since before it was read
  double read_seconds = 0;

  const TriangleSoup& soup() const { return std::get<TriangleSoup>(scene->primitives); }
};

struct Stage : StageSource {
  DrawingChoice choice;  // what `renderer` was made with
  Renderer renderer;
  double prepare_seconds = 0;

  const StageSource& source() const { return *this; }
};

/// What takes part in preparing; `context` describes the device, and one that shares with it is
/// current.
struct StageRequest {
  const gl::Context& context;
  DrawingChoice choice;
  std::function<void(double)> progress;  // 0..1; may throw to abandon
};

/// What draws a scene by a choice, in the context that is current. Throws DeviceLimitError,
/// UsageError.
Renderer prepare_renderer(const StageSource& scene, const StageRequest& request);

/// Reads a scene and prepares it. What was prepared has left the context: the thread that draws
/// takes over. Throws InputError, DeviceLimitError, UsageError.
std::unique_ptr<Stage> read_stage(const std::filesystem::path& path, const StageRequest& request);

/// Prepares what was read, likewise.
std::unique_ptr<Stage> prepare_stage(const StageSource& source, const StageRequest& request);

}  // namespace tureen::viewer
