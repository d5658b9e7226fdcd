// A scene that is ready to draw: read, planned and on the device. The worker creates it, the main
// thread uses it.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

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

/// A file of the scene.
struct SceneFile {
  std::filesystem::path path;
  FileWatch watch;  // created before it was read
  /// The file's scene as it was read, except that its layers are empty.
  std::shared_ptr<const Scene> header;
};

/// A layer of the scene. The user changes its place; its primitives never change, and jobs in the
/// background share them.
/// A single layer without a name has that of its file. The bounds are framed_bounds().
struct StageLayer : LayerPlace {
  std::shared_ptr<const Primitives> primitives = {};
  std::size_t file = 0, index = 0;  // the file, and the layer in it

  /// Null for splats.
  const TriangleSoup* soup() const { return std::get_if<TriangleSoup>(primitives.get()); }
  /// Triangles or splats.
  std::size_t primitive_count() const;
};

/// A scene that was read.
struct StageSource {
  std::vector<SceneFile> files;  // also those whose layers were removed; not empty
  /// Cameras, quality and info. Its layers are empty: the drawn ones are below. A removed
  /// layer stays in it until the next file is read.
  std::shared_ptr<const Scene> scene;
  std::vector<StageLayer> layers;  // in drawing order
  Subject subject;                 // with the guessed up axis
  UpGuess up;
  double read_seconds = 0;

  /// The first file.
  const std::filesystem::path& path() const { return files.front().path; }
  /// The files with layers; the first file if there are none.
  std::vector<std::filesystem::path> paths() const;
  /// The layer with the place that its file gives it.
  const Layer& as_read(const StageLayer& layer) const;
  /// Whether reading paths() gives this scene: no layer was moved, hidden, reordered, or removed
  /// alone from its file.
  bool is_as_read() const;
};

bool has_splats(const StageSource& source);

/// all_notes() with the window's controls that change assumptions.
std::vector<std::string> window_notes(const SceneInfo& info);
/// The window_notes() of the files as a scene of several files has them: with names.
std::vector<std::string> named_notes(const StageSource& source);

/// The layers for the runtime. They refer to the source's primitives.
std::vector<PlacedLayer> placed_layers(const StageSource& source);

/// The reason why this debug view is not available, from the first layer that lacks it.
std::optional<std::string> why_not(DebugView what, const StageSource& source);
/// The number of features that every layer has.
int feature_count(const StageSource& source);

/// A layer that the device refused.
struct RefusedLayer {
  std::string name;
  std::uint64_t forecast_bytes = 0;  // of its buffers and textures
  std::string reason;                // the device's
};

/// "Forecast: 512.0 MiB. .."
std::string describe(const RefusedLayer& layer);

struct Stage : StageSource {
  DrawingChoice choice;
  /// If the renderer was prepared for debug views; otherwise it was prepared by the choice. There
  /// is one renderer for both, so that the device holds the scene once, or twice while another
  /// stage is prepared.
  std::optional<DebugViews> debug_views;
  Renderer renderer;
  double prepare_seconds = 0;
  std::vector<RefusedLayer> refused = {};  // those are not in `layers`

  const StageSource& source() const { return *this; }
  /// Whether add_to() accepts this stage.
  bool can_grow() const { return !debug_views && choice.pipeline == PipelineKind::tureen; }
};

/// The inputs of reading.
struct ReadRequest {
  std::vector<std::filesystem::path> paths;
  std::function<void(double)> progress;  // 0..1; may throw to abandon
  /// Called before each file is read.
  std::function<void(const std::filesystem::path&)> begins = [](const auto&) {};
  /// Called for a file of `paths` with an error; the other files are read. Without this function,
  /// and if no file remains, the error is thrown.
  std::function<void(const std::filesystem::path&, const std::string& reason)> unreadable = {};
  std::optional<std::uint64_t> max_splats = {};  // ReadOptions::max_splats
};

/// The layers of all files, in one scene (merged() in scene/scene.hpp). Throws InputError, and
/// UsageError for too many layers.
StageSource read_source(const ReadRequest& request);
/// The same after the layers of `before`, which stay as they are; so does its up axis.
StageSource read_more(const StageSource& before, const ReadRequest& request);
/// Reads the files of `before` again that have layers, and then those of the request. The user's
/// changes stay, as in keep_changes().
StageSource read_again(const StageSource& before, const ReadRequest& request);

/// A part of a large file, to be shown while all of it is read (formats/scene_preview.hpp).
struct SourcePreview {
  StageSource source;       // without notes: the whole scene has them
  std::uint64_t bytes = 0;  // leading bytes of the file
};
/// The next preview, after one of `shown` bytes (0: none yet). Returns nullopt if there is none,
/// also for a file with errors: its reader reports them. `check` is called between the steps; may
/// throw to abandon.
std::optional<SourcePreview> read_source_preview(
    const std::filesystem::path& path, std::uint64_t shown,
    const std::function<void()>& check = [] {});

/// Gives the layers the order, places and visibility that the user chose in `before`, and removes
/// those that the user removed. Layers are the same if they have the same name and position in
/// their file. `source` has the files of `before`, and perhaps further ones, whose layers follow.
void keep_changes(StageSource& source, const StageSource& before);

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

/// Prepares a scene that was read. The renderer has left the context, so that the drawing thread
/// can use it. Throws DeviceLimitError and UsageError.
std::unique_ptr<Stage> prepare_stage(const StageSource& source, const StageRequest& request);

/// The same without the layers that the device refuses. Throws DeviceLimitError if it refuses all.
std::unique_ptr<Stage> prepare_fitting_stage(const StageSource& source,
                                             const StageRequest& request);

/// Prepares a scene that was read, for debug views, as prepare_stage.
std::unique_ptr<Stage> prepare_debug_stage(const StageSource& source, const StageRequest& request);

/// Layers on the device, to be added to a stage that is shown.
struct StageAddition {
  StageSource source;                    // with the layers of the stage and all new ones
  std::vector<StageLayer> layers = {};   // the new ones that fit
  std::vector<Renderer> renderers = {};  // for each of them; they have left their context
  std::vector<RefusedLayer> refused = {};
};

/// Prepares the layers of `source` after the first `present`, which are on the device. Throws
/// UsageError.
StageAddition prepare_addition(const StageSource& source, std::size_t present,
                               const StageRequest& request);

/// Adds the layers. What is on the device stays there. Needs Stage::can_grow().
void add_to(Stage& stage, StageAddition addition);

/// Gives the stage these of its layers, in this order and at these places, without uploading. The
/// layers are compared by their primitives; those that the stage does not have are ignored.
void arrange_layers(Stage& stage, std::vector<StageLayer> wanted);

}  // namespace tureen::viewer
