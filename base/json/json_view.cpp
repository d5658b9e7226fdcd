#include "base/json/json_view.hpp"

#include <cmath>

#include "base/json/json_limits.hpp"
#include "base/shown_text.hpp"

namespace tureen {

using nlohmann::json;

json parse_json(std::string_view text, const std::string& file, std::uint64_t first_byte,
                MemoryBudget budget) {
  take_json_memory(text, file, first_byte, std::move(budget));
  try {
    return json::parse(text.begin(), text.end());
  } catch (const json::parse_error& error) {
    // The useful part of the parser's message follows "syntax error ".
    std::string detail = error.what();
    const std::size_t start = detail.find("syntax error ");
    if (start != std::string::npos) detail = detail.substr(start + 13);
    throw InputError({file, first_byte + (error.byte > 0 ? error.byte - 1 : 0), {}},
                     "not valid JSON: " + detail);
  } catch (const json::out_of_range& error) {
    throw json_number_too_large(error.what(), text, file, first_byte);
  }
}

JsonView JsonView::operator[](const char* key) const {
  if (std::optional<JsonView> member = find(key)) return *std::move(member);
  fail(std::string("lacks \"") + key + "\"");
}

std::optional<JsonView> JsonView::find(const char* key) const {
  if (!value_->is_object()) fail("expected an object");
  const auto it = value_->find(key);
  if (it == value_->end()) return std::nullopt;
  return JsonView(*it, *file_, path_.empty() ? key : path_ + "." + key);
}

std::size_t JsonView::size() const {
  if (!value_->is_array()) fail("expected an array");
  return value_->size();
}

JsonView JsonView::at(std::size_t index) const {
  if (index >= size())
    fail("has no element " + std::to_string(index) + ", only " + std::to_string(size()));
  return JsonView((*value_)[index], *file_, path_ + "[" + std::to_string(index) + "]");
}

std::uint64_t JsonView::natural(std::uint64_t limit) const {
  std::uint64_t result = 0;
  if (value_->is_number_unsigned()) {
    result = value_->get<std::uint64_t>();
  } else {
    const double real = number();
    // Above 2^53, a double cannot represent every whole number.
    if (!(real >= 0.0 && real <= 9007199254740992.0) || real != std::floor(real))
      fail("expected a whole number, not " + value_->dump());
    result = static_cast<std::uint64_t>(real);
  }
  if (result > limit) fail(std::to_string(result) + " exceeds " + std::to_string(limit));
  return result;
}

double JsonView::number() const {
  if (!value_->is_number()) fail("expected a number");
  return value_->get<double>();
}

float JsonView::number_float() const {
  const double real = number();
  // Casting a double outside the range of float is undefined behaviour.
  if (!(std::abs(real) <= double(std::numeric_limits<float>::max())))
    fail("the number exceeds the range of a 32-bit float");
  return static_cast<float>(real);
}

bool JsonView::boolean() const {
  if (!value_->is_boolean()) fail("expected true or false");
  return value_->get<bool>();
}

const std::string& JsonView::text() const {
  if (!value_->is_string()) fail("expected a string");
  return value_->get_ref<const std::string&>();
}

std::size_t JsonView::one_of(std::span<const char* const> names) const {
  const std::string& have = text();
  std::string list;
  std::size_t index = 0;
  for (const char* name : names) {
    if (have == name) return index;
    list += (index++ > 0 ? ", " : "") + std::string(name);
  }
  fail("\"" + have + "\" is not supported; expected one of " + list);
}

void JsonView::fail(const std::string& reason, const std::string& hint) const {
  // Path and reason may contain text from the file. An unescaped NUL would cut the message, and a
  // newline could forge another message.
  throw InputError({*file_}, shown_text(path_.empty() ? reason : path_ + ": " + reason), hint);
}

}  // namespace tureen
