// Characters of UTF-8, one at a time: for text that must be looked at before it is shown.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace tureen {

struct Utf8Character {
  std::uint32_t code = 0;
  std::size_t length = 0;  // in bytes; 0 where they are no character
};

/// The character that begins at byte `at` of `text`, which is before its end.
Utf8Character utf8_character(std::string_view text, std::size_t at);

}  // namespace tureen
