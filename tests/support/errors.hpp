// Assertions on errors, independent of the message's wording: class, place and values.
//
//   EXPECT_THAT(error_of([&] { read_off("a.off"); }), ErrorAt("a.off:5", "face", 0, -1));
//   EXPECT_THAT(error_of<UsageError>(write), ErrorAt("", "16-16-16-3"));
//   EXPECT_THAT(program.err, Names("--scale", 0.25));
//
// Values help a user to find the fault: the name of a property, option or file, or a wrong number.
// They survive rewording. Plain words are not values.
#pragma once

#include <gmock/gmock.h>

#include <algorithm>
#include <cctype>
#include <initializer_list>
#include <optional>
#include <ostream>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.hpp"

namespace tureen::test {

/// An error in the form that tests compare.
struct Refusal {
  std::string file;
  std::string position;  // ":LINE", "@BYTE" or ""
  std::string reason;    // including its hint
};

inline std::ostream& operator<<(std::ostream& stream, const Refusal& refusal) {
  return stream << "an error at \"" << refusal.file << refusal.position << "\": " << refusal.reason;
}

inline Refusal refusal_of(const Error& error) {
  const std::string what = error.what();
  Refusal refusal{error.position().file, "", what.substr(to_string(error.position()).size())};
  if (error.position().line) refusal.position += ":" + std::to_string(*error.position().line);
  if (error.position().byte) refusal.position += "@" + std::to_string(*error.position().byte);
  return refusal;
}

/// The error of exactly this class that `call` throws, or nullopt. Any other exception passes
/// through and fails the test.
template <class Expected = InputError, class Call>
std::optional<Refusal> error_of(Call&& call) {
  try {
    call();
  } catch (const Expected& error) {
    return refusal_of(error);
  }
  return std::nullopt;
}

/// Whether `text` contains `value` as a whole word: "3" is not in "13", "3.5" or "v3".
inline bool holds_value(std::string_view text, std::string_view value) {
  const auto is_word = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
  };
  const auto is_digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  for (std::size_t at = text.find(value); at != std::string_view::npos;
       at = text.find(value, at + 1)) {
    const std::string_view before = text.substr(0, at), after = text.substr(at + value.size());
    const bool begins = before.empty() || !is_word(value.front()) || !is_word(before.back());
    const bool ends = after.empty() || !is_word(value.back()) || !is_word(after.front());
    const bool in_decimal =
        (before.size() > 1 && before.back() == '.' && is_digit(value.front()) &&
         is_digit(before[before.size() - 2])) ||
        (after.size() > 1 && after.front() == '.' && is_digit(value.back()) && is_digit(after[1]));
    if (begins && ends && !in_decimal) return true;
  }
  return value.empty();
}

/// A value in the form of messages. Not a template, because hundreds of assertions have values.
struct Value {
  Value() = default;
  Value(const char* value) : text(value) {}
  Value(std::string value) : text(std::move(value)) {}
  Value(int value) : text(std::to_string(value)) {}
  Value(unsigned value) : text(std::to_string(value)) {}
  Value(long value) : text(std::to_string(value)) {}
  Value(unsigned long value) : text(std::to_string(value)) {}
  Value(double value) {
    std::ostringstream stream;
    stream << value;
    text = stream.str();
  }
  std::string text;  // "" always matches
};

/// Matches a text or an error that contains each of the values.
class NamesMatcher {
 public:
  using is_gtest_matcher = void;
  explicit NamesMatcher(std::initializer_list<Value> values) {
    for (const Value& value : values)
      if (!value.text.empty()) values_.push_back(value.text);
  }

  bool MatchAndExplain(std::string_view text, ::testing::MatchResultListener* listener) const {
    return std::all_of(values_.begin(), values_.end(), [&](const std::string& value) {
      if (holds_value(text, value)) return true;
      *listener << "which lacks " << value;
      return false;
    });
  }
  bool MatchAndExplain(const std::optional<Refusal>& refusal,
                       ::testing::MatchResultListener* listener) const {
    return refusal && MatchAndExplain(std::string_view(refusal->reason), listener);
  }
  void DescribeTo(std::ostream* stream) const {
    *stream << "names " << ::testing::PrintToString(values_);
  }
  void DescribeNegationTo(std::ostream* stream) const {
    *stream << "does not name all of " << ::testing::PrintToString(values_);
  }

 private:
  std::vector<std::string> values_;
};

inline NamesMatcher Names(const Value& a = {}, const Value& b = {}, const Value& c = {},
                          const Value& d = {}, const Value& e = {}, const Value& f = {},
                          const Value& g = {}) {
  return NamesMatcher({a, b, c, d, e, f, g});
}

/// Matches an error at exactly this place ("file", "file:LINE", "file@BYTE"; without leading
/// folders if desired) that contains each of the values.
class ErrorAtMatcher {
 public:
  using is_gtest_matcher = void;
  enum class Position { exact, any };
  ErrorAtMatcher(std::string place, Position position, NamesMatcher names)
      : place_(std::move(place)), position_(position), names_(std::move(names)) {}

  bool MatchAndExplain(const std::optional<Refusal>& refusal,
                       ::testing::MatchResultListener* listener) const {
    if (!refusal) {
      *listener << "which is not an error";
      return false;
    }
    std::string place = refusal->file;
    if (position_ == Position::exact) place += refusal->position;
    if (place != place_ && !place.ends_with("/" + place_)) {
      *listener << "which is at another place";
      return false;
    }
    return names_.MatchAndExplain(refusal, listener);
  }
  void DescribeTo(std::ostream* stream) const {
    *stream << "is an error " << (position_ == Position::any ? "in \"" : "at \"") << place_
            << "\" that ";
    names_.DescribeTo(stream);
  }
  void DescribeNegationTo(std::ostream* stream) const {
    *stream << "not: ";
    DescribeTo(stream);
  }

 private:
  std::string place_;
  Position position_;
  NamesMatcher names_;
};

inline ErrorAtMatcher ErrorAt(const std::string& place, const Value& a = {}, const Value& b = {},
                              const Value& c = {}, const Value& d = {}, const Value& e = {},
                              const Value& f = {}) {
  return {place, ErrorAtMatcher::Position::exact, Names(a, b, c, d, e, f)};
}

/// As ErrorAt, at any line or byte of `file`.
inline ErrorAtMatcher ErrorIn(const std::string& file, const Value& a = {}, const Value& b = {},
                              const Value& c = {}, const Value& d = {}) {
  return {file, ErrorAtMatcher::Position::any, Names(a, b, c, d)};
}

}  // namespace tureen::test
