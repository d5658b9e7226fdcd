#include "base/json/json_file.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

#include "base/json/json_limits.hpp"

namespace tureen {

namespace {

/// The reason for a parse error. Programs that write JSON without a library often write NaN and
/// infinities, which JSON does not have.
std::string what_is_wrong(std::string_view text, std::size_t byte) {
  if (text.empty()) return "the file is empty";
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
    return "the text is UTF-16; save it as UTF-8";
  for (const std::string_view word : {"NaN", "nan", "-Infinity", "Infinity", "-inf", "inf"})
    // The parser stops at the first letter that it rejects, which may lie within the word.
    for (std::size_t back = 0; back < word.size() && back <= byte; ++back)
      if (text.substr(byte - back, word.size()) == word)
        return "not valid JSON: " + std::string(word) + " is not a JSON number";
  return "not valid JSON";
}

/// The text with null for what no double holds.
std::string without_non_finite(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    std::size_t end = i + 1;
    if (c == '"') {
      while (end < text.size() && text[end] != '"') end += text[end] == '\\' ? 2 : 1;
      end = std::min(end + 1, text.size());
    } else if (std::isalnum(static_cast<unsigned char>(c)) || c == '-') {
      while (end < text.size() &&
             (std::isalnum(static_cast<unsigned char>(text[end])) ||
              std::string_view("+-.").find(text[end]) != std::string_view::npos))
        ++end;
      const std::string token(text.substr(i, end - i));
      char* stop = nullptr;
      // It also reads "inf" and "nan", in any case, and gives infinity for too large numbers.
      const double value = std::strtod(token.c_str(), &stop);
      if (*stop == '\0' && !std::isfinite(value)) {
        result += "null";
        i = end;
        continue;
      }
    }
    result += text.substr(i, end - i);
    i = end;
  }
  return result;
}

/// Rejects a repeated key in an object.
class KeyWatch {
 public:
  explicit KeyWatch(Input& input) : input_(input) {}

  bool operator()(int, nlohmann::json::parse_event_t event, const nlohmann::json& parsed) {
    using Event = nlohmann::json::parse_event_t;
    if (event == Event::object_start) keys_.emplace_back();
    if (event == Event::object_end) keys_.pop_back();
    if (event == Event::key && !keys_.back().insert(parsed.get<std::string>()).second)
      input_.fail_at(0, "\"" + parsed.get<std::string>() + "\" occurs twice");
    return true;
  }

 private:
  Input& input_;
  std::vector<std::set<std::string>> keys_;  // of each open object
};

}  // namespace

nlohmann::json read_json(Input& input, RepeatedKeys repeated, NonFinite non_finite) {
  if (input.remaining() > max_json_bytes)
    input.fail("the JSON has " + std::to_string(input.remaining()) + " bytes, the limit is " +
               std::to_string(max_json_bytes));
  std::string text = input.read_text();
  if (non_finite == NonFinite::null) text = without_non_finite(text);
  take_json_memory(text, input.name(), 0, input.budget());
  try {
    if (repeated == RepeatedKeys::refused) return nlohmann::json::parse(text, KeyWatch(input));
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::parse_error& error) {
    // The parser counts bytes from 1. For a truncated text, its byte is one past the end.
    const std::size_t byte = error.byte > 0 ? error.byte - 1 : 0;
    input.fail_at(byte, what_is_wrong(text, byte));
  } catch (const nlohmann::json::out_of_range& error) {
    throw json_number_too_large(error.what(), text, input.name());
  }
}

float json_float(const nlohmann::json& value, const std::string& file, const std::string& what) {
  if (!value.is_number()) throw InputError({file}, what + " is not a number");
  const auto number = static_cast<float>(value.get<double>());
  if (!std::isfinite(number)) throw InputError({file}, what + " is not a finite number");
  return number;
}

std::vector<float> json_floats(const nlohmann::json& value, std::size_t count,
                               const std::string& file, const std::string& what) {
  if (!value.is_array() || value.size() != count)
    throw InputError({file}, what + " is not a list of " + std::to_string(count) + " numbers" +
                                 (value.is_array() ? ", but has " + std::to_string(value.size())
                                                   : std::string()));
  std::vector<float> numbers;
  numbers.reserve(count);
  for (std::size_t i = 0; i < count; ++i)
    numbers.push_back(json_float(value[i], file, what + "[" + std::to_string(i) + "]"));
  return numbers;
}

const nlohmann::json& json_at(const nlohmann::json& object, const char* key,
                              const std::string& file) {
  if (!object.is_object()) throw InputError({file}, "not a JSON object");
  const auto found = object.find(key);
  if (found == object.end()) throw InputError({file}, std::string("has no \"") + key + "\"");
  return *found;
}

}  // namespace tureen
