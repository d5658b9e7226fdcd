// Reads numbers and words from a text of any size, line by line, through a window of fixed size.
// The text formats (OFF, ascii PLY) share it. Every failure names the line.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/decimal.hpp"
#include "base/input.hpp"

namespace tureen {

struct TextSyntax {
  /// Start of a comment, which extends to the end of the line; NUL for a text without comments.
  char comment = '\0';
  /// Number of the first line, for a text that begins inside a file.
  std::uint64_t first_line = 1;
};

/// A line ends with LF, CR or CR LF; blanks are space, tab, vertical tab and form feed. Only
/// next_line() and next_content() cross the end of a line.
///
/// Does not support quotes, escapes, or words longer than max_word characters.
class TextScanner {
 public:
  static constexpr std::size_t window = 256 * 1024;
  /// Longest word or number in characters; longer ones are rejected.
  static constexpr std::size_t max_word = 1024;

  /// Reads `input` from its position on, without the byte order mark that a text may begin with.
  /// The input must outlive the scanner, which reads ahead.
  explicit TextScanner(Input& input, TextSyntax syntax = {});

  std::uint64_t line() const { return line_; }
  /// Bytes from the start of the file to the next character.
  std::uint64_t position() const { return input_.position() - std::uint64_t(end_ - next_); }
  /// Bytes from the next character to the end of the file.
  std::uint64_t remaining() const { return input_.size() - position(); }

  /// Skips blanks and a comment. Returns whether the line has no more content.
  bool at_line_end();
  /// Advances to the start of the next line. Returns false at the end of the text.
  bool next_line();
  /// Advances to the next character outside blanks and comments, across lines. Returns false at the
  /// end.
  bool next_content();
  /// Ends a line of data. Fails if more content follows: "more than WHAT on this line".
  void expect_line_end(const char* what);

  /// The next number or word on this line. A blank, the end of the line or a comment must follow.
  /// Throws an InputError that it expected `what`.
  float read_float(const char* what) { return read_decimal(what).value; }
  Decimal read_decimal(const char* what);
  std::int64_t read_integer(const char* what);
  /// read_integer, rejected outside [low, high] with the value and the bounds.
  std::int64_t read_integer(const char* what, std::int64_t low, std::int64_t high);
  std::string read_word(const char* what);
  /// The rest of this line, without blanks around it, at most max_word characters; "" at its end.
  std::string read_line();

  /// The next word, cut to `count` characters, without consuming it.
  std::string_view peek(std::size_t count);
  /// Skips `count` characters that peek() has returned.
  void skip(std::size_t count) { next_ += count; }

  [[noreturn]] void fail(const std::string& reason, const std::string& hint = {}) const;

 private:
  void skip_blanks();
  /// To the next line break, or to the end of the text.
  void skip_to_line_break();
  /// Ensures that the window holds a whole word: max_word characters, or the rest of the text.
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
