// PLY polygon files: ascii and binary of both byte orders, read and written.
//
// Read: vertices x y z of any type; faces as a list vertex_indices or vertex_index of any polygon
// size (fans), or a tristrips element (-1 begins a new strip); colours red green blue [alpha] of
// vertices or faces as uchar (0..255), ushort (0..65535), float or double (0..1), where
// diffuse_red .. stand for red ..; everything else in the file is passed over exactly. Elements may
// come in any order. Positions that are not finite are kept; bytes after the last element are
// noted. A face that names a vertex which is not there refuses the file (SECURITY.md says why).
//
// Not read: Gaussian splats and point clouds, which have no faces; both are told what they are.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/input.hpp"
#include "formats/mesh/ply_header.hpp"
#include "formats/scene_file.hpp"
#include "scene/scene.hpp"

namespace tureen {

/// A soup with VertexColors or FaceColors, up (0, 0, 1). Throws InputError with the byte (binary)
/// or the line (header and ascii).
Scene read_ply(Input& input, const ReadOptions& options = {});
Scene read_ply(const std::filesystem::path& path, const ReadOptions& options = {});

/// Binary, little endian; reads back bit for bit. Colours are uchar where that is exact, float
/// where it is not; alpha is always there. Returns what is lost. Other
/// appearances become a mean colour a face. Throws OutputError.
std::vector<std::string> write_ply(const Scene& scene, const std::filesystem::path& path);

}  // namespace tureen
