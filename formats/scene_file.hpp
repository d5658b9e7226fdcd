// Reads and writes scene files of every format. Reading detects the format by content; writing
// selects it by extension.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "formats/read_options.hpp"
#include "scene/scene.hpp"

namespace tureen {

/// Whether a reader recognises the content. Throws InputError if the path cannot be opened.
bool is_scene(const std::filesystem::path& path);

/// Thrown by the page's own program: its second one reads the file.
struct ReadElsewhere : InputError {
  using InputError::InputError;
};

/// Reads any scene of known_formats(). The scene has triangles or splats, and no defect(). Throws
/// InputError.
Scene read_scene(const std::filesystem::path& path, const ReadOptions& options = {});

/// Throws UsageError if write_scene would reject the name.
void require_written_format(const std::filesystem::path& path);

/// Options of all writers. A writer applies those that concern its format.
struct WriteOptions {
  int spz_version = 4;  // or 3, for programs without version 4
  /// As that of write_tureen_glb(); other writers do not call it.
  std::function<void(double)> progress = {};
};

/// Writes by the extension of `path`, the longest that a format has; a DiffSoup export folder if
/// there is none. The output is complete or absent. Returns one sentence for each loss of the
/// format. Throws UsageError if the format cannot store this scene or the extension is unknown.
/// Throws OutputError if the output cannot be written.
std::vector<std::string> write_scene(const Scene& scene, const std::filesystem::path& path,
                                     const WriteOptions& options = {});

/// Whether the format of this extension stores splats with a loss that images show.
bool is_quantised(const std::filesystem::path& path);

/// The up axis that readers assume of this scene in the format of `path`, which stores none;
/// nullopt if it stores the axis. Throws UsageError like require_written_format().
std::optional<glm::vec3> assumed_up_of(const Scene& scene, const std::filesystem::path& path);

/// One row of the table of formats, for help texts.
struct FormatInfo {
  std::string name;         // "OFF"
  std::string description;  // its contents, in a few words
  /// With the dot; the usual one first. Empty if reading or writing is not supported.
  std::vector<std::string> read_extensions, written_extensions;
  bool is_folder = false;  // a folder, in addition to any extensions
  bool can_read = false;
  bool can_write = false;
  bool holds_layers = false;  // several
};

/// Every format that read_scene or write_scene supports.
std::vector<FormatInfo> known_formats();

}  // namespace tureen
