#include "base/text_scanner.hpp"

#include <algorithm>
#include <cstring>

namespace tureen {

namespace {

constexpr bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
constexpr bool is_line_break(char c) { return c == '\n' || c == '\r'; }

/// A word for a message: at most 40 characters, with dots for unprintable ones.
std::string quoted(std::string_view word) {
  constexpr std::size_t most = 40;
  std::string text = "'";
  for (const char c : word.substr(0, most)) text += c < ' ' || c > '~' ? '.' : c;
  return text + (word.size() > most ? "..'" : "'");
}

}  // namespace

TextScanner::TextScanner(Input& input, TextSyntax syntax)
    : input_(input),
      syntax_(syntax),
      // Fuzzing reads many small files, so a small file gets a small buffer.
      buffer_(static_cast<std::size_t>(std::min<std::uint64_t>(window, input.remaining())) + 1),
      line_(syntax.first_line) {
  next_ = end_ = buffer_.data();
  if (input_.position() > 0) return;
  refill();
  const std::string_view start(next_, std::size_t(end_ - next_));
  if (start.starts_with("\xff\xfe") || start.starts_with("\xfe\xff"))
    fail("the text is UTF-16", "save it as UTF-8");
  if (start.starts_with("\xef\xbb\xbf")) next_ += 3;
}

void TextScanner::refill() {
  const auto kept = static_cast<std::size_t>(end_ - next_);
  std::memmove(buffer_.data(), next_, kept);
  const std::size_t got = input_.read_some(
      std::as_writable_bytes(std::span(buffer_.data() + kept, buffer_.size() - 1 - kept)));
  next_ = buffer_.data();
  end_ = next_ + kept + got;
  buffer_[kept + got] = '\0';
}

bool TextScanner::ends_word(char c) const {
  return is_blank(c) || is_line_break(c) || c == '\0' || (c == syntax_.comment);
}

void TextScanner::skip_blanks() {
  look_ahead();
  while (is_blank(*next_)) {
    ++next_;
    // A run of blanks may be longer than the window.
    if (next_ == end_) refill();
  }
  look_ahead();
}

bool TextScanner::at_line_end() {
  skip_blanks();
  if (syntax_.comment && *next_ == syntax_.comment && next_ != end_) skip_to_line_break();
  return next_ == end_ || is_line_break(*next_);
}

void TextScanner::skip_to_line_break() {
  for (;;) {
    while (next_ != end_ && !is_line_break(*next_)) ++next_;
    if (next_ != end_) return;
    refill();
    if (next_ == end_) return;
  }
}

bool TextScanner::next_line() {
  skip_to_line_break();
  if (next_ == end_) return false;
  look_ahead();  // so that the window holds both bytes of a CR LF
  next_ += next_[0] == '\r' && next_[1] == '\n' ? 2 : 1;
  ++line_;
  return true;
}

bool TextScanner::next_content() {
  while (at_line_end())
    if (!next_line()) return false;
  return true;
}

void TextScanner::expect_line_end(const char* what) {
  if (!at_line_end())
    fail(std::string("more than ") + what + " on this line: " + quoted(peek(max_word)));
}

Decimal TextScanner::read_decimal(const char* what) {
  skip_blanks();
  const Decimal number = parse_decimal({next_, std::size_t(end_ - next_)});
  pass_number(number.end, what, "a number");
  return number;
}

std::int64_t TextScanner::read_integer(const char* what) {
  skip_blanks();
  const Integer number = parse_integer({next_, std::size_t(end_ - next_)});
  pass_number(number.end, what, "a whole number");
  return number.value;
}

std::int64_t TextScanner::read_integer(const char* what, std::int64_t low, std::int64_t high) {
  const std::int64_t value = read_integer(what);
  if (value < low || value > high)
    fail(std::string(what) + " of " + std::to_string(value) + " is outside " + std::to_string(low) +
         ".." + std::to_string(high));
  return value;
}

std::string TextScanner::read_line() {
  if (at_line_end()) return {};
  look_ahead();
  std::size_t size = 0;
  while (next_ + size != end_ && !is_line_break(next_[size])) ++size;
  if (size > max_word) fail("the line has more than " + std::to_string(max_word) + " characters");
  std::string line(next_, size);
  next_ += size;
  while (is_blank(line.back())) line.pop_back();
  return line;
}

std::string TextScanner::read_word(const char* what) {
  if (at_line_end()) fail_expected(what, "a word");
  std::string word(peek(max_word));
  if (word.empty() || !ends_word(next_[word.size()])) fail_expected(what, "a word");
  skip(word.size());
  return word;
}

std::string_view TextScanner::peek(std::size_t count) {
  skip_blanks();
  count = std::min(count, static_cast<std::size_t>(end_ - next_));
  std::size_t length = 0;
  while (length < count && !ends_word(next_[length])) ++length;
  return {next_, length};
}

void TextScanner::pass_number(const char* end, const char* what, const char* kind) {
  if (!end || !ends_word(*end)) fail_expected(what, kind);
  // A number that reaches the end of the window may continue after it.
  if (std::size_t(end - next_) > max_word)
    fail(std::string(what) + " has more than " + std::to_string(max_word) + " characters");
  next_ = end;
}

void TextScanner::fail_expected(const char* what, const char* kind) {
  if (at_line_end())
    fail(std::string(next_ == end_ ? "the file" : "the line") + " ends where " + what +
         " is expected");
  const std::string_view word = peek(max_word);
  // Only a NUL is left: every other character is a blank, ends the line or begins a word.
  if (word.empty()) fail(std::string("a NUL byte where ") + what + " is expected");
  fail(quoted(word) + " where " + what + " is expected: not " + kind);
}

void TextScanner::fail(const std::string& reason, const std::string& hint) const {
  throw InputError({input_.name(), {}, line_}, reason, hint);
}

}  // namespace tureen
