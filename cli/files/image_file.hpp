// Images from and to files.
#pragma once

#include <filesystem>
#include <string>

#include "image/image.hpp"

namespace tureen::cli {

/// A PNG or a JPEG. Throws InputError, also with a suggestion for a name that does not exist.
Image8 read_image(const std::filesystem::path& path);

/// A PNG, whole or not at all. Throws OutputError.
void write_image(const Image8& image, const std::filesystem::path& path);

/// Throws UsageError unless the name ends in .png: it is the one format that we write.
void require_png_name(const std::filesystem::path& path);

/// The name of image `index` of `count`: `pattern` as it is when there is one image and no
/// "%d" in it; else with "%d" or "%03d" replaced by the index, or the index put before the
/// extension, with leading zeros so that names sort: "out.png" becomes "out_00.png".
/// Throws UsageError for any other use of '%' ("%%" stands for one).
std::filesystem::path image_name(const std::string& pattern, int index, int count);

}  // namespace tureen::cli
