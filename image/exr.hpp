// OpenEXR files of 32-bit floats, for depths, normals and alpha: one part, uncompressed scanlines.
// Written by hand because the format's library has several run-time dependencies, and this subset
// is small (openexr.com, "OpenEXR File Layout").
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace tureen {

/// A channel of the image. Names are the format's: "R", "G", "B", "A", "Z" (depth).
struct ExrChannel {
  std::string name;               // at most 31 bytes
  std::span<const float> values;  // width * height, row 0 on top
};

/// The file. Asserts at least one channel, different names, and sizes that match.
std::vector<std::byte> encode_exr(int width, int height, std::vector<ExrChannel> channels);

}  // namespace tureen
