// Images that a failed image test writes.
#pragma once

#include <filesystem>
#include <string>

#include "image/image.hpp"

namespace tureen::test {

/// Writes `folder`/NAME.png, and creates the folder.
void write_evidence(const Image8& image, const std::filesystem::path& folder,
                    const std::string& name);

/// The difference of each colour channel, times 16 so that a single step is visible; opaque.
/// Requires equal sizes.
Image8 enlarged_difference(const Image8& a, const Image8& b);

}  // namespace tureen::test
