// Polygons in PLY files: ascii and binary of both byte orders, read and written.
//
// Supported for vertices: x y z and nx ny nz of any type. Supported for faces: a list
// vertex_indices or vertex_index with any polygon size (fans), or a tristrips element (-1 begins a
// new strip). Colours of vertices or faces are red green blue [alpha] as uchar (0..255), ushort
// (0..65535), float or double (0..1); diffuse_red .. are aliases of red .. Other elements and
// properties are skipped exactly. Elements may come in any order. Non-finite positions are kept.
// Bytes after the last element give a remark. A face with a missing vertex is an error (SECURITY.md
// has the reason).
//
// Not supported: point clouds, which have no faces; the error names them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/input.hpp"
#include "formats/ply/ply_header.hpp"
#include "formats/read_options.hpp"
#include "scene/scene.hpp"

namespace tureen {

/// A soup with VertexColors or FaceColors and up (0, 0, 1). Throws InputError with the byte
/// (binary) or the line (header and ascii).
Scene read_mesh_ply(Input& input, const PlyHeader& header, const ReadOptions& options);

/// Binary, little endian; reads back bit for bit. Colours are uchar if that is exact, otherwise
/// float, always with alpha. Other appearances become a mean colour a face. Returns the losses.
/// Throws OutputError, and UsageError for more than 2^31 - 1 vertices or for several layers.
std::vector<std::string> write_mesh_ply(const Scene& scene, const std::filesystem::path& path);

}  // namespace tureen
