// Files that stand where a scene was expected, and are something else altogether.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace tureen {

/// What a file is that no format recognises, for people and with what to do about it: a page that a
/// server sent in place of the file, a pointer of Git LFS, a picture. `head` is its first bytes, as
/// many as there are. Nothing where nothing is known of it.
std::optional<std::string> stray_content(std::span<const std::byte> head);

}  // namespace tureen
