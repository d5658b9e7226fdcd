// OFF and COFF, the text format of Geomview: vertices and polygons with colours. Triangle Splatting
// (arXiv 2505.19175) exports its soups as COFF with one colour a face.
//
// Supported: one vertex or face a line, as every exporter writes it; comments (#) and blank lines
// anywhere. The counts follow on the line of the header word or after it; the number of edges is
// optional. A vertex is x y z, or x y z and its colour. A face is its number of corners, their
// vertices, and nothing, a colour map index (ignored, with a remark) or its colour. Colours are r g
// b or r g b a, integers 0..255 or floats 0..1. A colour with only the values 0 and 1 uses the
// scale of the other colours. Polygons become fans of triangles. Both "OFF" and "COFF" may have
// either kind of colour.
//
// Not supported: normals, texture coordinates and other dimensions (NOFF, STOFF, 4OFF, nOFF ..),
// and binary OFF. Errors name the variant.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "base/input.hpp"
#include "formats/read_options.hpp"
#include "scene/scene.hpp"

namespace tureen {

/// Whether a file with these first bytes is an OFF of any kind.
bool is_off(std::span<const std::byte> head);

/// A soup with VertexColors or FaceColors and up (0, 0, 1). Throws InputError with the line.
Scene read_off(Input& input, const ReadOptions& options = {});
Scene read_off(const std::filesystem::path& path, const ReadOptions& options = {});

/// Positions are written so that they read back bit for bit. Colours become rounded bytes, with
/// alpha if it differs from 1. FaceColors give an "OFF", VertexColors a "COFF", and other
/// appearances a mean colour a face. Returns the losses. Throws OutputError.
std::vector<std::string> write_off(const Scene& scene, const std::filesystem::path& path);

}  // namespace tureen
