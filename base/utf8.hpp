// Decodes UTF-8 one character at a time, for text that is checked before printing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace tureen {

struct Utf8Character {
  std::uint32_t code = 0;
  std::size_t length = 0;  // in bytes; 0 if the bytes are not a character
};

/// The character that begins at byte `at` of `text`; `at` is below its size.
Utf8Character utf8_character(std::string_view text, std::size_t at);

}  // namespace tureen
