// OFF and COFF, the text format of Geomview: vertices and polygons with colours. Triangle Splatting
// (arXiv 2505.19175) exports its soups as COFF with a colour a face.
//
// Read: one vertex, one face a line, as every exporter writes it; comments (#) and blank lines
// anywhere; the counts on the line of the header word or after it, the number of edges optional.
// A vertex is x y z, or x y z and its colour; a face is its number of corners, their vertices, and
// nothing, a colour map index (ignored, noted) or its colour. Colours are r g b or r g b a, whole
// numbers 0..255 or floats 0..1; a colour of nothing but 0s and 1s is on the scale of the others.
// Polygons become fans of triangles. Both "OFF" and "COFF" may carry either kind of colour.
//
// Not read: normals, texture coordinates and other dimensions (NOFF, STOFF, 4OFF, nOFF ..) and
// binary OFF, refused by name.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "base/input.hpp"
#include "formats/scene_file.hpp"
#include "scene/scene.hpp"

namespace tureen {

/// Whether a file that begins with these bytes calls itself an OFF of any kind.
bool is_off(std::span<const std::byte> head);

/// A soup with VertexColors or FaceColors, up (0, 0, 1). Throws InputError with the line.
Scene read_off(Input& input, const ReadOptions& options = {});
Scene read_off(const std::filesystem::path& path, const ReadOptions& options = {});

/// Positions are written so that they read back bit for bit; colours as bytes, rounded, with alpha
/// where it is not 1. FaceColors make an "OFF", VertexColors a "COFF". Returns what is lost.
/// Other appearances become a mean colour a face. Throws OutputError.
std::vector<std::string> write_off(const Scene& scene, const std::filesystem::path& path);

}  // namespace tureen
