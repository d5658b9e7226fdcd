#include "base/utf8.hpp"

namespace tureen {

Utf8Character utf8_character(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) -> std::uint32_t {
    return static_cast<unsigned char>(text[i]);
  };
  const std::uint32_t first = byte(at);
  const std::size_t length = first < 0x80       ? 1
                             : first >> 5 == 6  ? 2
                             : first >> 4 == 14 ? 3
                             : first >> 3 == 30 ? 4
                                                : 0;
  if (length < 2) return {first, length};
  if (at + length > text.size()) return {};
  std::uint32_t code = first & (0x7fu >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if (byte(at + i) >> 6 != 2) return {};
    code = code << 6 | (byte(at + i) & 0x3fu);
  }
  // Rejects overlong encodings, surrogates and codes beyond Unicode.
  constexpr std::uint32_t least[]{0, 0, 0x80, 0x800, 0x10000};
  const bool allowed =
      code >= least[length] && (code < 0xd800 || code > 0xdfff) && code <= 0x10ffff;
  return allowed ? Utf8Character{code, length} : Utf8Character{};
}

}  // namespace tureen
