// The syntax of .usda: words, strings and values in an untrusted text.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "base/memory_budget.hpp"

namespace tureen {

/// Reads a text that it does not copy. Every failure names the line of `file`.
class UsdText {
 public:
  UsdText(std::string_view text, std::string file, MemoryBudget budget)
      : text_(text), file_(std::move(file)), budget_(std::move(budget)) {}

  /// Skips blanks, line ends and comments. Returns whether more follows.
  bool next();
  /// Skips blanks only; returns whether the line has more content.
  bool next_on_line();
  /// The next character, or NUL at the end.
  char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  /// Skips `c` after blanks and line ends, if it is next.
  bool take(char c);
  void expect(char c);
  /// Letters, digits and _ : . [ ], as in names and types of attributes; empty if none is next.
  std::string_view word();
  /// A text in single or double quotes, also three of them.
  std::string_view quoted();
  /// Skips a value: a word, string, path or asset, or everything up to the matching bracket.
  void skip_value();
  /// The text of a value, as skip_value() skips it.
  std::string_view value_text();
  /// All numbers of a value, without its brackets and commas.
  std::vector<double> numbers();
  /// The same as floats, rounded once.
  std::vector<float> floats();

  [[noreturn]] void fail(const std::string& reason, const std::string& hint = {}) const;

 private:
  template <class Number>
  std::vector<Number> read_numbers();

  std::string_view text_;
  std::string file_;
  MemoryBudget budget_;
  std::size_t at_ = 0;
};

}  // namespace tureen
