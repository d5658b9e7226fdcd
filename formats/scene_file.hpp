// Reads and writes scene files of every format. Reading detects the format by content; writing
// selects it by extension.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace tureen {

/// The colour space of COLOR_0 in a foreign glTF. The specification requires linear values, but
/// common Python tools write display-referred ones. `automatic` decides by the file's generator and
/// adds a remark.
enum class VertexColorSpace { automatic, srgb, linear };

class EarlyTexels;  // formats/early_texels.hpp

struct ReadOptions {
  VertexColorSpace vertex_colors = VertexColorSpace::automatic;
  /// Q > 0 of octagon meshes (formats/splat/octagon_npz.hpp). nullopt: 4, with a remark.
  std::optional<double> octagon_q = {};
  /// Maximum number of splats, at least 1. The reader keeps those that contribute the most
  /// (scene/edit/splat_limit.hpp), with a remark. Readers of splat files hold an eighth more while
  /// they read, that of our GLB all shapes, but only the kept colours, others everything.
  std::optional<std::uint64_t> max_splats = {};
  /// Whether readers that reorder or drop splats fill Splats::rows. Not for our GLB, which keeps
  /// the order.
  bool keep_rows = false;
  /// Called with the number of splats in the file and their bytes in memory, before that memory is
  /// taken; may throw to stop. Not for triangle windows and foreign glTF.
  std::function<void(std::uint64_t splats, std::uint64_t bytes)> found_splats = {};
  /// Texels of this file that are decoded already, or null. The reader takes them if they fit.
  EarlyTexels* early_texels = nullptr;
  /// Called with the fraction done, 0..1; may throw to cancel.
  std::function<void(double)> progress = {};
};

/// Whether a reader recognises the content. Throws InputError if the path cannot be opened.
bool is_scene(const std::filesystem::path& path);

/// Reads any supported scene: .glb/.gltf (ours and foreign), .off, .coff, .ply, .splat, .spz, .npz,
/// a DiffSoup export folder, a MobileNeRF folder (or its .obj), a .pt checkpoint. The scene has
/// triangles or splats, and no defect(). Throws InputError.
Scene read_scene(const std::filesystem::path& path, const ReadOptions& options = {});

/// Throws UsageError if write_scene would reject the name.
void require_written_format(const std::filesystem::path& path);

/// Writes by the extension of `path`: .glb, .off, .coff, .ply, or a DiffSoup export folder if there
/// is none. The output is complete or absent. Returns one sentence for each loss of the format.
/// Throws UsageError if the format cannot store this scene or the extension is unknown. Throws
/// OutputError if the output cannot be written.
std::vector<std::string> write_scene(const Scene& scene, const std::filesystem::path& path);

/// One row of the table of formats, for help texts.
struct FormatInfo {
  std::string name;         // "OFF"
  std::string description;  // its contents, in a few words
  /// With the dot; the usual one first. Empty if reading or writing is not supported.
  std::vector<std::string> read_extensions, written_extensions;
  bool is_folder = false;  // a folder, in addition to any extensions
  bool can_read = false;
  bool can_write = false;
};

/// Every format that read_scene or write_scene supports.
std::vector<FormatInfo> known_formats();

}  // namespace tureen
