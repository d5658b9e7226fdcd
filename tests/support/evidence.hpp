// What a failed image test leaves behind to look at.
#pragma once

#include <filesystem>
#include <string>

#include "image/image.hpp"

namespace tureen::test {

/// Writes `folder`/NAME.png; makes the folder.
void write_evidence(const Image8& image, const std::filesystem::path& folder,
                    const std::string& name);

/// The difference of each colour channel, times 16 so that a single step can be seen; opaque. The
/// sizes are equal.
Image8 enlarged_difference(const Image8& a, const Image8& b);

}  // namespace tureen::test
