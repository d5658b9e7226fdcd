// The GLSL files of this folder, embedded at build time.
#pragma once

#include <string_view>

namespace tureen::shaders {

/// The text of a file by its name, such as "shading.frag"; empty if there is no such file.
std::string_view text(std::string_view name);

}  // namespace tureen::shaders
