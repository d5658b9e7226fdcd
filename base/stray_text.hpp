// Recognises texts that stand where a binary file should be: an unfinished download.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

namespace tureen {

struct StrayText {
  const char* reason;  // "a Git LFS pointer instead of the file"
  const char* hint;    // may be empty
};

/// What the first bytes of a file are instead of its content: nothing, a Git LFS pointer, or the
/// web page of a server. `head` has as many bytes as exist, at most some hundred.
std::optional<StrayText> stray_text(std::span<const std::byte> head);

/// Whether `text` begins with `lower_case`, in any case.
bool begins_with_any_case(std::string_view text, std::string_view lower_case);

}  // namespace tureen
