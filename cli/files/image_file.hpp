// Reads and writes image files.
#pragma once

#include <filesystem>
#include <string>

#include "image/image.hpp"

namespace tureen::cli {

/// Reads a PNG or a JPEG. Throws InputError, with a suggestion if the path does not exist.
Image8 read_image(const std::filesystem::path& path);

/// Writes a PNG, completely or not at all. Throws OutputError.
void write_image(const Image8& image, const std::filesystem::path& path);

/// Throws UsageError unless the name ends in .png, the only format that write_image() supports.
void require_png_name(const std::filesystem::path& path);

/// The name of image `index` of `count`. "%d" or "%03d" in `pattern` is replaced by the index.
/// Without them, `pattern` is the name of a single image. The names of several images then have the
/// index before the extension, with leading zeros so that they sort: "out.png" becomes
/// "out_00.png". "%%" is a percent sign; throws UsageError for any other use of '%'.
std::filesystem::path image_name(const std::string& pattern, int index, int count);

}  // namespace tureen::cli
