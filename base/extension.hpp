// How a path ends, which tells formats where no content does.
#pragma once

#include <filesystem>
#include <string>

namespace tureen {

/// With its dot and in small letters, as cameras and Windows write them large: ".glb" of "a.GLB";
/// empty where there is none.
std::string extension_of(const std::filesystem::path& path);

}  // namespace tureen
