// PLY files: ascii and binary of both byte orders, read and written. Files of splats are recognised
// by their properties and left to formats/splat/; the rest of this page is about polygons.
//
// Supported for vertices: x y z of any type. Supported for faces: a list vertex_indices or
// vertex_index with any polygon size (fans), or a tristrips element (-1 begins a new strip).
// Colours of vertices or faces are red green blue [alpha] as uchar (0..255), ushort (0..65535),
// float or double (0..1); diffuse_red .. are aliases of red .. Other elements and properties are
// skipped exactly. Elements may come in any order. Non-finite positions are kept. Bytes after the
// last element give a remark. A face with a missing vertex is an error (SECURITY.md has the
// reason).
//
// Not supported: point clouds, which have no faces; the error names them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/input.hpp"
#include "formats/mesh/ply_header.hpp"
#include "formats/scene_file.hpp"
#include "scene/scene.hpp"

namespace tureen {

/// A soup with VertexColors or FaceColors and up (0, 0, 1), or splats (splat/splat_ply.hpp,
/// splat/compressed_ply.hpp). Throws InputError with the byte
/// (binary) or the line (header and ascii).
Scene read_ply(Input& input, const ReadOptions& options = {});
Scene read_ply(const std::filesystem::path& path, const ReadOptions& options = {});

/// Binary, little endian; reads back bit for bit. Colours are uchar if that is exact, otherwise
/// float, always with alpha. Other appearances become a mean colour a face. A scene of one layer
/// with Gaussians or neural densities is written as splats. Returns the losses. Throws OutputError.
std::vector<std::string> write_ply(const Scene& scene, const std::filesystem::path& path);

}  // namespace tureen
