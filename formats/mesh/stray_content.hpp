// Recognises common files that are not scenes.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace tureen {

struct StrayContent {
  const char* reason;
  const char* hint;
};

/// The reason and the hint of the error for a file that no format recognises: an HTML page that a
/// server sent instead of the file, a Git LFS pointer, an image, an archive, a format of splats or
/// tiles that is not supported. `head` is its first bytes, as many
/// as exist. Returns nullopt for unknown content.
std::optional<StrayContent> stray_content(std::span<const std::byte> head);

}  // namespace tureen
