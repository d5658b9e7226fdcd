// Reads numbers and words from a text of any size, line by line, through a window of fixed size:
// what the text formats (OFF, ascii PLY) have in common. Every failure names the line.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/decimal.hpp"
#include "base/input.hpp"

namespace tureen {

struct TextSyntax {
  /// From here to the end of the line is a comment; NUL for a text without comments.
  char comment = '\0';
  /// The number of the first line, where the text begins inside a file.
  std::uint64_t first_line = 1;
};

/// A line ends with LF, CR or CR LF; blanks are space, tab, vertical tab and form feed. Nothing
/// here crosses the end of a line but next_line() and next_content().
///
/// Not for texts with quotes or escapes, and not for numbers of more than max_word characters.
class TextScanner {
 public:
  static constexpr std::size_t window = 256 * 1024;
  /// Words and numbers up to this long are whole in the window; longer ones are refused.
  static constexpr std::size_t max_word = 1024;

  /// Reads `input` from its position on. The input must outlive the scanner, which reads ahead.
  explicit TextScanner(Input& input, TextSyntax syntax = {});

  std::uint64_t line() const { return line_; }
  /// Bytes from the start of the file to the next character.
  std::uint64_t position() const { return input_.position() - std::uint64_t(end_ - next_); }
  /// Bytes from the next character to the end of the file.
  std::uint64_t remaining() const { return input_.size() - position(); }

  /// Skips blanks and a comment: whether nothing else is left on this line.
  bool at_line_end();
  /// Goes to the start of the next line; false, at the end of the text, where there is none.
  bool next_line();
  /// Goes to the next character that is neither blank nor comment, across lines; false at the end.
  bool next_content();
  /// Ends a line of data: fails where something is left on it, as "more than WHAT on this line".
  void expect_line_end(const char* what);

  /// The number or word that comes next on this line. Each must be followed by a blank, the end
  /// of the line or a comment, and throws an InputError that names `what` was expected there.
  float read_float(const char* what) { return read_decimal(what).value; }
  Decimal read_decimal(const char* what);
  std::int64_t read_integer(const char* what);
  /// read_integer, refused outside [low, high] with the value and the bounds.
  std::int64_t read_integer(const char* what, std::int64_t low, std::int64_t high);
  std::string read_word(const char* what);

  /// The longest part of the next word that is at most `count` characters, without consuming it.
  std::string_view peek(std::size_t count);
  /// Passes over `count` characters that peek() has shown.
  void skip(std::size_t count) { next_ += count; }

  [[noreturn]] void fail(const std::string& reason, const std::string& hint = {}) const;

 private:
  void skip_blanks();
  /// Makes sure that a word is whole in the window: max_word characters, or all that are left.
  void look_ahead() {
    if (std::size_t(end_ - next_) <= max_word) refill();
  }
  void refill();
  bool ends_word(char c) const;
  void pass_number(const char* end, const char* what, const char* kind);
  [[noreturn]] void fail_expected(const char* what, const char* kind);

  Input& input_;
  TextSyntax syntax_;
  std::vector<char> buffer_;
  const char* next_;
  const char* end_;  // *end_ is always NUL, which ends every number and word
  std::uint64_t line_;
};

}  // namespace tureen
