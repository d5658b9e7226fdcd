#include "base/json/json_limits.hpp"

#include <optional>

namespace tureen {

namespace {

/// Whether a parser gets past the first character. Otherwise the parser should report that the text
/// is not JSON, instead of an error about nesting in arbitrary bytes.
bool may_be_json(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // a byte order mark
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first != text.npos &&
         std::string_view("{[\"-0123456789tfn").find(text[first]) != std::string_view::npos;
}

/// An upper bound of the number of values and keys that a parser creates from `text`, whether or
/// not it is JSON; 1 if it stops at the first character. Throws InputError if the nesting exceeds
/// max_json_depth. The error names the byte in `file`, where `text` begins at `first_byte`.
std::uint64_t count_json_values(std::string_view text, const std::string& file,
                                std::uint64_t first_byte) {
  std::uint64_t values = 1;
  if (!may_be_json(text)) return values;
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\')
        ++i;  // an escaped character does not end the string
      else if (c == '"')
        in_string = false;
      continue;
    }
    switch (c) {
      case '"':
        in_string = true;
        break;
      case '[':
      case '{':
        if (++depth > max_json_depth)
          throw InputError(
              {file, first_byte + i, {}},
              "JSON is nested deeper than " + std::to_string(max_json_depth) + " levels");
        ++values;
        break;
      case ']':
      case '}':
        --depth;
        break;
      case ',':
      case ':':
        ++values;
        break;
      default:
        break;
    }
  }
  return values;
}

}  // namespace

void take_json_memory(std::string_view text, const std::string& file, std::uint64_t first_byte,
                      MemoryBudget budget) {
  const std::uint64_t values = count_json_values(text, file, first_byte);
  if (!budget.take(values, json_value_bytes) || !budget.take(text.size()))
    throw InputError({file, first_byte, {}}, budget.refusal("the JSON"), max_memory_hint);
}

InputError json_number_too_large(std::string_view message, std::string_view text,
                                 const std::string& file, std::uint64_t first_byte) {
  const std::size_t begin = message.find('\''), end = message.rfind('\'');
  const std::string_view number =
      begin < end ? message.substr(begin + 1, end - begin - 1) : std::string_view();
  // If the digits occur more than once, the position is ambiguous and omitted.
  std::optional<std::uint64_t> byte;
  if (const std::size_t at = text.find(number); at != text.npos && at == text.rfind(number))
    byte = first_byte + at;
  return {{file, byte, {}}, "the number " + std::string(number) + " is too large"};
}

}  // namespace tureen
