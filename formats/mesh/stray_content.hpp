// Files that stand where a scene was expected, and are something else altogether.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace tureen {

struct StrayContent {
  const char* reason;
  const char* hint;
};

/// The reason and the hint for an error about a file that no format recognises: a page that a
/// server sent in place of the file, a pointer of Git LFS, a picture. `head` is its first bytes, as
/// many as there are. Nothing where nothing is known of it.
std::optional<StrayContent> stray_content(std::span<const std::byte> head);

}  // namespace tureen
