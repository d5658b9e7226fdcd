// The one door to scene files: told by content, not only by name.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace tureen {

/// What COLOR_0 of a foreign glTF holds. The specification says linear; common Python tools write
/// display-referred values. `automatic` decides by the file's generator and adds a remark.
enum class VertexColorSpace { automatic, srgb, linear };

struct ReadOptions {
  VertexColorSpace vertex_colors = VertexColorSpace::automatic;
  /// Called now and then with the fraction done, 0..1; may throw to abandon the read.
  std::function<void(double)> progress;
};

/// Whether a reader recognises what lies there by its content. Throws InputError where it cannot be
/// opened.
bool is_scene(const std::filesystem::path& path);

/// Reads any scene that we know: .glb/.gltf (ours and foreign), .off, .ply, a DiffSoup export
/// folder, a MobileNeRF folder (or its .obj), a .pt checkpoint. The scene has no defect(), and
/// triangles. Throws InputError.
Scene read_scene(const std::filesystem::path& path, const ReadOptions& options = {});

/// Throws UsageError where write_scene would for the name alone.
void require_written_format(const std::filesystem::path& path);

/// Writes by the extension of `path` (.glb, .off, .ply; a DiffSoup export folder where there is no
/// extension), whole or not at all. Returns what the format cannot hold, a sentence each. Throws
/// UsageError when the format cannot hold this scene at all or the extension is unknown, and
/// OutputError.
std::vector<std::string> write_scene(const Scene& scene, const std::filesystem::path& path);

/// One line of the table of formats, for help texts.
struct FormatInfo {
  std::string name;         // "OFF"
  std::string description;  // what it holds, in a few words
  /// With the point; the first is the usual one. None where it cannot be read, or not be written.
  std::vector<std::string> read_extensions, written_extensions;
  bool is_folder = false;  // a folder, beside any extensions
  bool can_read = false;
  bool can_write = false;
};

/// Every format that read_scene and write_scene know.
std::vector<FormatInfo> known_formats();

}  // namespace tureen
