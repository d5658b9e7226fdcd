#include "base/shown_text.hpp"

#include <cstdint>

#include "base/utf8.hpp"

namespace tureen {

namespace {

/// Whether `code` controls a terminal or the direction of text, or is not a character.
bool is_steering(std::uint32_t code) {
  return code < 0x20 || (code >= 0x7f && code <= 0x9f) ||  // C0, DEL and C1
         code == 0x061c || code == 0x200e || code == 0x200f ||
         (code >= 0x2028 && code <= 0x202e) ||  // ends of lines and paragraphs, and directions
         (code >= 0x2066 && code <= 0x2069) || code == 0xfffe || code == 0xffff;
}

void append_hexadecimal(std::string& text, std::uint32_t value, int digits) {
  for (int shift = 4 * (digits - 1); shift >= 0; shift -= 4)
    text += "0123456789abcdef"[value >> shift & 15u];
}

void append_escaped(std::string& text, std::uint32_t code) {
  if (code == '\n') {
    text += "\\n";
  } else if (code == '\r') {
    text += "\\r";
  } else if (code == '\t') {
    text += "\\t";
  } else {
    text += "\\u";
    append_hexadecimal(text, code, 4);
  }
}

bool begins_character(char c) { return (static_cast<unsigned char>(c) & 0xc0u) != 0x80u; }

}  // namespace

std::string shown_text(std::string_view text) {
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const Utf8Character character = utf8_character(text, at);
    if (character.length == 0) {
      result += "\\x";
      append_hexadecimal(result, static_cast<unsigned char>(text[at]), 2);
      ++at;
      continue;
    }
    if (is_steering(character.code))
      append_escaped(result, character.code);
    else
      result.append(text, at, character.length);
    at += character.length;
  }
  return result;
}

std::string shown_line(std::string_view text) {
  // Enough for each of our messages with two paths of usual length.
  constexpr std::size_t most = 1000;
  std::string shown = shown_text(text);
  if (shown.size() <= most) return shown;
  std::size_t head = most / 2, tail = shown.size() - most / 2;
  while (!begins_character(shown[head])) --head;
  while (!begins_character(shown[tail])) ++tail;  // the last character begins somewhere
  return shown.substr(0, head) + " [.. " + std::to_string(tail - head) + " more bytes ..] " +
         shown.substr(tail);
}

}  // namespace tureen
