#include "formats/json_file.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

namespace tureen {

nlohmann::json read_json(Input& input) {
  if (input.remaining() > max_json_bytes)
    input.fail("JSON of " + std::to_string(input.remaining()) + " bytes, the limit is " +
               std::to_string(max_json_bytes));
  const auto bytes = input.read_rest();
  const auto* text = reinterpret_cast<const char*>(bytes.data());
  try {
    return nlohmann::json::parse(text, text + bytes.size());
  } catch (const nlohmann::json::parse_error& error) {
    // Its byte counts from 1, and is one past the end where the text is cut short.
    input.fail_at(error.byte > 0 ? error.byte - 1 : 0, "not valid JSON");
  } catch (const nlohmann::json::exception& error) {
    input.fail_at(0, std::string("JSON that cannot be read: ") + error.what());
  }
}

float json_float(const nlohmann::json& value, const std::string& file, const std::string& what) {
  if (!value.is_number()) throw InputError({file, {}, {}}, what + " is not a number");
  const auto number = static_cast<float>(value.get<double>());
  if (!std::isfinite(number)) throw InputError({file, {}, {}}, what + " is not a finite number");
  return number;
}

std::vector<float> json_floats(const nlohmann::json& value, std::size_t count,
                               const std::string& file, const std::string& what) {
  if (!value.is_array() || value.size() != count)
    throw InputError(
        {file, {}, {}},
        what + " is not a list of " + std::to_string(count) + " numbers" +
            (value.is_array() ? ", but of " + std::to_string(value.size()) : std::string()));
  std::vector<float> numbers;
  numbers.reserve(count);
  for (std::size_t i = 0; i < count; ++i)
    numbers.push_back(json_float(value[i], file, what + "[" + std::to_string(i) + "]"));
  return numbers;
}

const nlohmann::json& json_at(const nlohmann::json& object, const char* key,
                              const std::string& file) {
  if (!object.is_object()) throw InputError({file, {}, {}}, "not a JSON object");
  const auto found = object.find(key);
  if (found == object.end())
    throw InputError({file, {}, {}}, std::string("has no \"") + key + "\"");
  return *found;
}

}  // namespace tureen
