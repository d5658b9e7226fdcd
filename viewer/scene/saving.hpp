// Saves the document of a window as a scene file.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "viewer/scene/scene_source.hpp"

namespace tureen::viewer {

/// The scene that the document describes. Copies the primitives, which the writers need in one
/// scene.
Scene scene_of(const SceneSource& source);

/// Whether saving to the only file of this scene is safe without a question: a GLB of ours, or
/// another written format, read without loss.
bool can_be_replaced(const SceneFile& file);

/// A name that no file has, beside the scene's first file: "garden-2.glb".
std::filesystem::path proposed_file(const SceneSource& source);

/// The extensions of the formats that hold the scene: ".glb stores everything; other formats: ..".
std::string written_extensions(const SceneSource& source);

/// The reason why the scene cannot be saved under this name, or "". For the user.
std::string name_defect(const SceneSource& source, const std::filesystem::path& file);

/// A file that is removed at the end of its scope, if it still exists.
struct TemporaryFile {
  std::filesystem::path path;
  explicit TemporaryFile(std::filesystem::path file) : path(std::move(file)) {}
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
};

struct Saved {
  std::vector<std::string> lost;  // one sentence for each loss of the format
  bool is_written = false;
  SceneFile file = {};
};
/// Writes the scene by write_scene(), unless the format loses something and `accepts_losses` is
/// false. The file is complete, or as it was. `progress`: called with 0..1; may throw to give up.
/// Throws OutputError and UsageError.
Saved save_scene(const SceneSource& source, const std::filesystem::path& file, bool accepts_losses,
                 const std::function<void(double)>& progress = {});

/// Makes the file that was written from `saved` the only file of the source. Only of a GLB it is
/// known that reading it gives these layers: those of other formats then exist only in memory.
void adopt_file(SceneSource& source, const SceneSource& saved, SceneFile file);

}  // namespace tureen::viewer
