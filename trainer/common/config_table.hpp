// Tables of training constants: name, member, range and meaning of each field. The range check, the
// reader and the writer of --config files and --list-config use the table of a method.
#pragma once

#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "base/decimal.hpp"
#include "base/json/json_view.hpp"

namespace tureen::trainer {

/// The allowed numbers of a training constant, and the reason for the limits.
struct Range {
  enum class Ends { closed, low_open, high_open };
  double low = 0;
  double high = 0;
  Ends ends = Ends::closed;
  const char* reason = "";
  const char* reason_above = reason;  // the reason for numbers above `high`, if it differs

  bool contains(double value) const;
  /// "from 1 to 1024"; for an open end "more than 0, at most 1" or "from 0 to less than 1".
  std::string text() const;
  /// The error for a value outside the range: "0 is out of range; allowed: from 1 to 1024 (..)".
  /// `written`: the value as text in the file or on the command line.
  std::string refusal(double value, const std::string& written) const;
};

/// The ranges of constants that several methods have.
namespace ranges {
// Larger whole numbers are probably typing errors.
inline constexpr Range whole{
    1, 1e7, {}, "a run needs at least one step", "the run would take weeks"};
inline constexpr Range minutes{0,
                               1e5,
                               {},
                               "the value is a time, or 0 for a fixed number of steps",
                               "the run would take months"};
inline constexpr Range fraction{0, 1, {}, "the value is a fraction"};
inline constexpr Range weight{0, 1000, {}, "a negative weight would increase the error"};
inline constexpr Range color{0, 1, {}, "the value is a display-referred colour"};
// 2^64 - 1 is not a double, so the range ends at 2^64; it contains all values of the type.
inline constexpr Range any_seed{
    0, 18446744073709551616.0, {}, "the seed is an unsigned number of 64 bits"};
inline constexpr Range none{};
}  // namespace ranges

/// The shortest decimal that reads back as the same number.
std::string double_text(double value);

/// Three channels, display-referred.
using Color = float[3];

/// A member of the struct C. Its type determines the value in a file: a whole number, a number,
/// true or false, three numbers, or a word.
template <class C, class... Enumerations>
using ConfigMember = std::variant<int C::*, std::uint64_t C::*, float C::*, double C::*, bool C::*,
                                  Color C::*, Enumerations C::*...>;

template <class C, class... Enumerations>
struct BasicConfigField {
  const char* name;  // in files, and of the member
  ConfigMember<C, Enumerations...> member;
  Range range = {};                         // for numbers, and for each channel of a colour
  const char* meaning = "";                 // one line
  std::span<const char* const> words = {};  // for enumerations, in the order of the enumerators
};

/// The numbers of a field that its range limits.
template <class C, class... E>
std::vector<double> numbers(const C& config, const BasicConfigField<C, E...>& field) {
  return std::visit(
      [&](auto member) -> std::vector<double> {
        const auto& value = config.*member;
        using Value = std::remove_cvref_t<decltype(value)>;
        if constexpr (std::is_same_v<Value, Color>)
          return {std::begin(value), std::end(value)};
        else if constexpr (std::is_same_v<Value, bool> || std::is_enum_v<Value>)
          return {};
        else
          return {double(value)};
      },
      field.member);
}

/// The value in the form of a --config file: 0.8, true, "random", [1, 1, 1].
template <class C, class... E>
std::string value_text(const C& config, const BasicConfigField<C, E...>& field) {
  return std::visit(
      [&](auto member) -> std::string {
        const auto& value = config.*member;
        using Value = std::remove_cvref_t<decltype(value)>;
        if constexpr (std::is_same_v<Value, Color>)
          return "[" + float_text(value[0]) + ", " + float_text(value[1]) + ", " +
                 float_text(value[2]) + "]";
        else if constexpr (std::is_same_v<Value, bool>)
          return value ? "true" : "false";
        else if constexpr (std::is_enum_v<Value>)
          return "\"" + std::string(field.words[std::size_t(value)]) + "\"";
        else if constexpr (std::is_same_v<Value, float>)
          return float_text(value);
        else if constexpr (std::is_same_v<Value, double>)
          return double_text(value);
        else
          return std::to_string(value);
      },
      field.member);
}

/// The error of the first field outside its range, for example "steps: 0 is out of range; allowed:
/// from 1 to 10000000 (a run needs at least one step)".
template <class C, class... E>
std::optional<std::string> range_defect(const C& config,
                                        std::span<const BasicConfigField<C, E...>> fields) {
  for (const auto& field : fields)
    for (const double value : numbers(config, field))
      if (!field.range.contains(value))
        return std::string(field.name) + ": " +
               field.range.refusal(value, value_text(config, field));
  return std::nullopt;
}

/// The first field that differs between a resumed run and its checkpoint, for example "steps is
/// 300, but the checkpoint has 40"; nothing if all are equal.
template <class C, class... E>
std::optional<std::string> first_difference(const C& now, const C& checkpoint,
                                            std::span<const BasicConfigField<C, E...>> fields) {
  for (const auto& field : fields) {
    const std::string here = value_text(now, field), there = value_text(checkpoint, field);
    if (here != there)
      return std::string(field.name) + " is " + here + ", but the checkpoint has " + there;
  }
  return std::nullopt;
}

/// All fields as one JSON object, a field per line; assign_fields() restores the same bits.
template <class C, class... E>
std::string fields_to_json(const C& config, std::span<const BasicConfigField<C, E...>> fields) {
  std::string text = "{\n";
  for (const auto& field : fields)
    text += std::string(text.size() > 2 ? ",\n" : "") + "  \"" + field.name +
            "\": " + value_text(config, field);
  return text + "\n}\n";
}

/// Sets a field to the value in a file and checks its type. Ranges are checked later, all at once.
template <class C, class... E>
void assign_field(C& config, const BasicConfigField<C, E...>& field, const JsonView& value) {
  std::visit(
      [&](auto member) {
        auto& target = config.*member;
        using Value = std::remove_reference_t<decltype(target)>;
        const std::string written = value.value().dump();
        if constexpr (std::is_same_v<Value, Color>) {
          if (value.size() != 3) value.fail("expected three numbers: red, green, blue");
          for (std::size_t c = 0; c < 3; ++c) target[c] = value.at(c).number_float();
        } else if constexpr (std::is_same_v<Value, bool>) {
          if (!value.value().is_boolean()) value.fail("expected true or false");
          target = value.value().template get<bool>();
        } else if constexpr (std::is_enum_v<Value>) {
          target = Value(value.one_of(field.words));
        } else if constexpr (std::is_same_v<Value, std::uint64_t>) {
          target = value.natural();
        } else if constexpr (std::is_same_v<Value, float>) {
          target = value.number_float();
        } else if constexpr (std::is_same_v<Value, double>) {
          target = value.number();
        } else {
          const double number = value.number();
          if (number != std::floor(number)) value.fail("expected a whole number, not " + written);
          // A number that does not fit an int is outside every range.
          if (std::abs(number) > std::numeric_limits<int>::max())
            value.fail(field.range.refusal(number, written));
          target = static_cast<int>(number);
        }
      },
      field.member);
}

/// Rejects unknown keys, with the nearest names, and lists all of them in one error.
void require_known_fields(const JsonView& root, std::span<const std::string> names);

/// Sets all fields that the document names. Throws InputError for unknown keys and wrong types.
template <class C, class... E>
void assign_fields(C& config, std::span<const BasicConfigField<C, E...>> fields,
                   const JsonView& root) {
  std::vector<std::string> names;
  for (const auto& field : fields) names.emplace_back(field.name);
  require_known_fields(root, names);
  for (const auto& field : fields)
    if (const std::optional<JsonView> value = root.find(field.name))
      assign_field(config, field, *value);
}

/// A field for --list-config: `defaults` after its name, its meaning, its range or words.
template <class C, class... E>
std::string field_reference(const C& config, const BasicConfigField<C, E...>& field,
                            const std::string& defaults) {
  std::string text = std::string(field.name) + ": " + defaults + "\n    " + field.meaning + "\n";
  if (!numbers(config, field).empty()) text += "    " + field.range.text() + "\n";
  std::string words;
  for (const char* word : field.words) words += (words.empty() ? "    " : ", ") + std::string(word);
  return words.empty() ? text : text + words + "\n";
}

}  // namespace tureen::trainer
