// Which of the files that the page has put into this instance's file system is the scene.
#pragma once

#include <filesystem>

#include "web/engine/values.hpp"

namespace tureen::web {

/// {"folder", "paths"}: the first of the paths, relative to the folder, that a reader recognises;
/// else the last, whose reader says what is wrong. Makes the folder the current one, so that errors
/// name files as the page does.
std::filesystem::path scene_path(const Json& arguments);

}  // namespace tureen::web
