// A scene that was read: its files, and the document that the user changes.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "camera/navigation.hpp"
#include "camera/up_axis.hpp"
#include "runtime/debug_views/debug_views.hpp"
#include "scene/document/history.hpp"
#include "scene/placed_layer.hpp"
#include "viewer/files/file_watch.hpp"

namespace tureen::viewer {

/// A file of the scene.
struct SceneFile {
  std::filesystem::path path;
  FileWatch watch;  // created before it was read
  /// The file's scene as it was read, except that its layers are empty.
  std::shared_ptr<const Scene> header;
  std::optional<std::size_t> lod = {};  // ReadOptions::lod
};

/// The levels of detail of a streamed scene, and the one that was read.
struct DetailLevels {
  std::size_t count = 0, level = 0;
};
/// Whether the remark names them, with `count` and `level` as its first fields.
bool names_levels(const Remark& remark);
/// nullopt for files without levels.
std::optional<DetailLevels> levels_of(const SceneFile& file);

/// The file of a layer, its index there, and the name that it got.
struct LayerOrigin {
  std::size_t file = 0, index = 0;
  std::string name = {};
};

/// Null for splats.
inline const TriangleSoup* soup_of(const DocumentLayer& layer) {
  return std::get_if<TriangleSoup>(layer.primitives.get());
}
inline const Splats* splats_of(const DocumentLayer& layer) {
  return std::get_if<Splats>(layer.primitives.get());
}
/// Triangles or splats.
std::size_t primitive_count(const DocumentLayer& layer);

struct SceneSource {
  std::vector<SceneFile> files;  // also those whose layers were removed; not empty
  /// Cameras, quality and info. Its layers are empty: those of the document are drawn.
  std::shared_ptr<const Scene> scene;
  /// What the user changes, by History. The bounds of its layers are framed_bounds().
  Document document;
  /// Also of removed layers. A layer without an origin exists only in memory.
  std::map<LayerId, LayerOrigin> origins;
  Subject subject;  // with the guessed up axis
  UpGuess up;
  double read_seconds = 0;

  /// The first file.
  const std::filesystem::path& path() const { return files.front().path; }
  /// The files with layers; the first file if there are none.
  std::vector<std::filesystem::path> paths() const;
  /// The layer with the place that its file gives it; null if it exists only in memory.
  const Layer* as_read(const DocumentLayer& layer) const;
  /// Whether reading paths() gives these layers: none was moved, hidden, renamed, reordered, or
  /// removed alone from its file.
  bool is_as_read() const;
  /// Whether all layers are those of files, which commands can read.
  bool is_from_files() const;
};

/// The first file's chosen level of detail; commands have one option for all files.
std::optional<std::size_t> lod_of(const SceneSource& source);

/// Whether the document has a layer of this file, or this layer of it.
bool has_layers(const SceneSource& source, std::size_t file, std::optional<std::size_t> index = {});
bool has_splats(const SceneSource& source);

/// The document's, or else the first file's; display-referred.
glm::vec3 background_of(const SceneSource& source);
/// The view that R shows: the document's, or else first_view_of() the first file
/// (camera/capture.hpp).
std::optional<Camera> first_view_of(const SceneSource& source);

/// all_notes() with the window's controls that change assumptions.
std::vector<std::string> window_notes(const SceneInfo& info);
/// The window_notes() of the files as a scene of several files has them: with names.
std::vector<std::string> named_notes(const SceneSource& source);

/// The layers for the runtime. They refer to the primitives.
std::vector<PlacedLayer> placed_layers(const std::vector<DocumentLayer>& layers);

/// Splats that are drawn with another profile than their own, by their layer.
struct ProfiledSplats {
  std::shared_ptr<const Primitives> stored = {}, drawn = {};
};
/// The layers for rays: splats with the document's profile. `known`, changed: of the call before,
/// so that the same document gives the same primitives, whose trees stay.
std::vector<DocumentLayer> layers_for_rays(const SceneSource& source,
                                           std::map<LayerId, ProfiledSplats>& known);

/// Whether the scene has triangles, for the words of debug views.
Subjects subjects_of(const SceneSource& source);
/// The reason why this debug view is not available, from the first layer that lacks it.
std::optional<std::string> why_not(DebugView what, const SceneSource& source);
/// The number of features that every layer has.
int feature_count(const SceneSource& source);

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
  std::optional<std::size_t> lod = {};           // ReadOptions::lod of the files in `paths`
  /// For read_again(): the index of a file, and the level of detail that it changes to.
  std::optional<std::pair<std::size_t, std::size_t>> level = {};
};

/// The layers of all files, in one scene (merged() in scene/scene.hpp). Throws InputError, and
/// UsageError for too many layers.
SceneSource read_source(const ReadRequest& request);
/// The same after the layers of `before`, which stay as they are; so does its up axis.
SceneSource read_more(const SceneSource& before, const ReadRequest& request);
/// Reads the files of `before` again that have layers, and then those of the request. Layers are
/// the same, and keep their ids, if they have the same name and position in their file. The
/// document is that of the files: keep_changes() adds the user's changes.
SceneSource read_again(const SceneSource& before, const ReadRequest& request);

/// Appends the layers and files that `more`, by read_more(), has after those of `known`, the source
/// that it was given. The source may have changed since; so have the indices of its files.
/// Returns the edit that adds the layers; afterwards, call merge_files().
AddLayers add_files(SceneSource& source, const SceneSource& more, const SceneSource& known);

/// Gives a source that was read again the user's changes, and the layers in memory, of `now`.
/// Layers that the user removed stay removed.
void keep_changes(SceneSource& read, const SceneSource& now);

/// Updates what depends on all files: the header, and the names of layers without one.
void merge_files(SceneSource& source);
/// Updates the subject after a change of the document.
void update_subject(SceneSource& source);

/// A part of a large file, to be shown while all of it is read (formats/scene_preview.hpp).
struct SourcePreview {
  SceneSource source;       // without notes: the whole scene has them
  std::uint64_t bytes = 0;  // leading bytes of the file
};
/// The next preview, after one of `shown` bytes (0: none yet). Returns nullopt if there is none,
/// also for a file with errors: its reader reports them. `check` is called between the steps; may
/// throw to abandon.
std::optional<SourcePreview> read_source_preview(
    const std::filesystem::path& path, std::uint64_t shown,
    const std::function<void()>& check = [] {});

}  // namespace tureen::viewer
