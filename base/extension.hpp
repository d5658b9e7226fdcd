// The extension of a path, for formats that content alone does not identify.
#pragma once

#include <filesystem>
#include <string>

namespace tureen {

/// With its dot, in lower case, since cameras and Windows write upper case: ".glb" from "a.GLB".
/// Empty if there is none.
std::string extension_of(const std::filesystem::path& path);

}  // namespace tureen
