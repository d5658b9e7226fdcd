// Tureen's own file format: a GLB with the vendor extension TUREEN_triangle_soup, which stores the
// scene exactly. Any glTF viewer opens it. Compressed files have the same extension, but store a
// scene with losses, and only Tureen reads them. docs/format.md specifies every byte.
//
// Not supported: foreign glTF, which formats/gltf/gltf.hpp reads (formats/gltf_file.hpp chooses),
// and files above 4 GiB, the limit of GLB.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/input.hpp"
#include "formats/read_options.hpp"
#include "scene/scene.hpp"

namespace tureen {

struct GlbContainer;

inline constexpr char tureen_extension[] = "TUREEN_triangle_soup";
inline constexpr int tureen_extension_version = 1;
/// Version of compressed files (formats/tureen_glb/tureen_glb_compressed.hpp). Version 2 used
/// another coding and was never released.
inline constexpr int tureen_compressed_version = 3;
/// Version of files with several layers, or with one layer that is hidden, named, rotated, scaled
/// or mirrored.
inline constexpr int tureen_layers_version = 4;
/// Version of files with a layer of splats, except triangle windows with the profile of Triangle
/// Splatting. Otherwise like version 4.
inline constexpr int tureen_splats_version = 5;

/// Reads the binary chunk in file order, directly into the scene's vectors. Additional memory: one
/// strip of texels or one harmonics coefficient of all splats. Every count is checked against the
/// available bytes before any allocation. The scene equals the written one bit by bit; no layer, no
/// soup and no splats have a defect(). Throws InputError.
Scene read_tureen_glb(Input& input, const ReadOptions& options = {});

/// The same for a container that has already been read.
Scene read_tureen_glb(Input& input, const GlbContainer& glb, const ReadOptions& options);

bool is_tureen_glb(const GlbContainer& glb);

/// Writes every kind of scene, including splats, and its quality. Returns one sentence for
/// each loss; the only possible loss is a text that is not UTF-8. Throws UsageError for a scene
/// that has no layer, more than max_layers, a layer, soup, splats or quality with a defect(), or no
/// up axis. It also throws UsageError for an image that is too large, a camera without pixels or
/// with a side above 65,536, non-finite numbers in a camera, material, up axis or background, and a
/// file above 4 GiB. Throws OutputError if the file cannot be written.
///
/// Memory in addition to the scene: the vertex colours for other glTF viewers (8 bytes a vertex of
/// the glTF mesh, and as many a splat), the encoded images, and a second copy of the harmonics of
/// splats, except triangle windows. Other arrays of the scene are written without a copy.
///
/// `progress`: called with 0..1; may throw to give up, then the file is as before.
std::vector<std::string> write_tureen_glb(const Scene& scene, const std::filesystem::path& path,
                                          const std::function<void(double)>& progress = {});

}  // namespace tureen
