// Tureen's own file: a GLB that any glTF viewer opens, with the vendor extension
// TUREEN_triangle_soup, which holds the scene exactly. docs/format.md specifies every byte.
//
// What it does not do: it does not read foreign glTF (formats/gltf/gltf.hpp does, and is the door
// to both), and it keeps no bytes beyond 4 GiB, which is as much as a GLB can hold.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/input.hpp"
#include "formats/scene_file.hpp"
#include "scene/scene.hpp"

namespace tureen {

struct GlbContainer;

inline constexpr char tureen_extension[] = "TUREEN_triangle_soup";
inline constexpr int tureen_extension_version = 1;
/// Of files whose soup is coded with a loss (formats/tureen_glb/tureen_glb_slim.hpp). Version 2 was
/// coded in another way, before any release.
inline constexpr int tureen_slim_version = 3;

/// Reads the binary chunk in the order in which it lies, straight into the scene's vectors: beyond
/// them it holds one strip of texels at a time. Every count is checked against the bytes that are
/// there before anything is allocated. The scene is what was written, bit by bit, and has no
/// defect(). Throws InputError.
Scene read_tureen_glb(Input& input, const ReadOptions& options = {});

/// The same for a container that has been read already.
Scene read_tureen_glb(Input& input, const GlbContainer& glb, const ReadOptions& options);

/// Whether this is one of our files.
bool is_tureen_glb(const GlbContainer& glb);

/// Writes every kind of scene, soft triangles too, and its quality. Returns what is lost, a
/// sentence each: nothing, unless a text is not UTF-8. Throws UsageError for a scene that has a
/// defect(), has no up axis, holds a camera without pixels or with more than 65,536 in a row or
/// column, holds a camera or a material with numbers that are not finite, does not fit into 4 GiB,
/// or whose quality has a defect(); OutputError where the file cannot be written.
///
/// Memory beside the scene: the final colours (8 bytes a vertex of the drawn mesh) and the encoded
/// images. Arrays of the scene are written from where they lie.
std::vector<std::string> write_tureen_glb(const Scene& scene, const std::filesystem::path& path);

}  // namespace tureen
