// Checked access to untrusted JSON. Every failure is an InputError with the file and the path
// within it, as in "accessors[3].count: expected a number". Include it only in sources.
#pragma once

#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/error.hpp"
#include "base/memory_budget.hpp"

namespace tureen {

/// Parses `text`, which begins at `first_byte` of `file`. Throws InputError with the byte if the
/// text is not JSON or exceeds the limits of base/json/json_limits.hpp.
nlohmann::json parse_json(std::string_view text, const std::string& file,
                          std::uint64_t first_byte = 0, MemoryBudget budget = MemoryBudget());

/// A place within a parsed document. The document and the file's name must outlive it.
class JsonView {
 public:
  JsonView(const nlohmann::json& value, const std::string& file, std::string path = "")
      : value_(&value), file_(&file), path_(std::move(path)) {}

  const nlohmann::json& value() const { return *value_; }
  const std::string& path() const { return path_; }

  /// The member `key`. Fails if it is missing or this value is not an object.
  JsonView operator[](const char* key) const;
  /// The same, but nullopt if the key is missing.
  std::optional<JsonView> find(const char* key) const;

  /// The number of elements. Fails if this value is not an array.
  std::size_t size() const;
  JsonView at(std::size_t index) const;

  /// A whole number in 0..limit. Numbers such as 3.0 count as whole, as in JSON.
  std::uint64_t natural(std::uint64_t limit = std::numeric_limits<std::uint64_t>::max()) const;
  double number() const;
  /// A number that a float can hold.
  float number_float() const;
  bool boolean() const;
  const std::string& text() const;
  /// The index of the text in `names`. Any other text fails with a list of the names.
  std::size_t one_of(std::span<const char* const> names) const;

  [[noreturn]] void fail(const std::string& reason, const std::string& hint = {}) const;

 private:
  const nlohmann::json* value_;
  const std::string* file_;
  std::string path_;
};

}  // namespace tureen
