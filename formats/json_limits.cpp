#include "formats/json_limits.hpp"

#include <optional>

namespace tureen {

std::uint64_t count_json_values(std::string_view text, const std::string& file,
                                std::uint64_t first_byte) {
  std::uint64_t values = 1;
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\')
        ++i;  // whatever is escaped does not end the string
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
          throw InputError({file, first_byte + i, {}},
                           "JSON nested deeper than " + std::to_string(max_json_depth) + " levels");
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

void take_json_memory(std::string_view text, const std::string& file, std::uint64_t first_byte,
                      MemoryBudget budget) {
  const std::uint64_t values = count_json_values(text, file, first_byte);
  if (!budget.take(values, json_value_bytes) || !budget.take(text.size()))
    throw InputError({file, first_byte, {}}, budget.refusal("the JSON"));
}

InputError json_number_too_large(std::string_view message, std::string_view text,
                                 const std::string& file, std::uint64_t first_byte) {
  const std::size_t begin = message.find('\''), end = message.rfind('\'');
  const std::string_view number =
      begin < end ? message.substr(begin + 1, end - begin - 1) : std::string_view();
  // Where it stands in a text, too, only one of its places is the number's.
  std::optional<std::uint64_t> byte;
  if (const std::size_t at = text.find(number); at != text.npos && at == text.rfind(number))
    byte = first_byte + at;
  return {{file, byte, {}}, "the number " + std::string(number) + " is too large"};
}

}  // namespace tureen
