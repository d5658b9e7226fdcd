#include "formats/usd/usd_text.hpp"

#include <fast_float/fast_float.h>

#include <algorithm>
#include <type_traits>

#include "base/decimal.hpp"
#include "base/error.hpp"

namespace tureen {

namespace {

/// Brackets nest at most so deep, as JSON does.
constexpr std::size_t max_usd_depth = 64;

bool is_usd_blank(char c) { return c == ' ' || c == '\t'; }
bool is_usd_line_end(char c) { return c == '\n' || c == '\r'; }
bool is_usd_word(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == ':' || c == '.' || c == '[' || c == ']';
}

}  // namespace

void UsdText::fail(const std::string& reason, const std::string& hint) const {
  const auto end = text_.begin() + std::ptrdiff_t(std::min(at_, text_.size()));
  throw InputError({file_, {}, std::uint64_t(1 + std::count(text_.begin(), end, '\n'))}, reason,
                   hint);
}

bool UsdText::next_on_line() {
  while (is_usd_blank(peek())) ++at_;
  if (peek() == '#')
    while (at_ < text_.size() && !is_usd_line_end(peek())) ++at_;
  return at_ < text_.size() && !is_usd_line_end(peek());
}

bool UsdText::next() {
  while (!next_on_line() && at_ < text_.size()) ++at_;
  return at_ < text_.size();
}

bool UsdText::take(char c) {
  next();
  if (peek() != c || at_ == text_.size()) return false;
  ++at_;
  return true;
}

void UsdText::expect(char c) {
  if (!take(c)) fail(std::string("expected '") + c + "'");
}

std::string_view UsdText::word() {
  const std::size_t first = at_;
  while (at_ < text_.size() && is_usd_word(peek())) ++at_;
  return text_.substr(first, at_ - first);
}

std::string_view UsdText::quoted() {
  const char quote = peek();
  if (quote != '"' && quote != '\'') fail("expected a text in quotes");
  const std::string three(3, quote);
  const std::size_t width = text_.substr(at_, 3) == three ? 3 : 1;
  const std::string_view mark = std::string_view(three).substr(0, width);
  const std::size_t first = at_ + width;
  for (std::size_t i = first; i < text_.size(); ++i) {
    if (text_[i] == '\\') {
      ++i;
    } else if (text_.substr(i, width) == mark) {
      at_ = i + width;
      return text_.substr(first, i - first);
    }
  }
  fail("the text in quotes has no end");
}

void UsdText::skip_value() {
  std::string open;
  do {
    if (!next()) fail("the file ends within a value");
    const char c = peek();
    if (c == '"' || c == '\'') {
      quoted();
    } else if (c == '<' || c == '@') {
      const std::size_t end = text_.find(c == '<' ? '>' : '@', at_ + 1);
      if (end == text_.npos) fail("a path has no end");
      at_ = end + 1;
    } else if (c == '(' || c == '[' || c == '{') {
      if (open.size() == max_usd_depth) fail("brackets nest more than 64 levels");
      open += c == '(' ? ')' : c == '[' ? ']' : '}';
      ++at_;
    } else if (!open.empty() && c == open.back()) {
      open.pop_back();
      ++at_;
    } else if (c == ')' || c == ']' || c == '}') {
      fail("a bracket closes that is not open");
    } else {
      ++at_;
      // A word of its own ends at the line's end; within brackets its parts need no care.
      if (open.empty())
        while (at_ < text_.size() && (is_usd_word(peek()) || peek() == '-' || peek() == '+')) ++at_;
    }
  } while (!open.empty());
}

std::string_view UsdText::value_text() {
  next();
  const std::size_t first = at_;
  skip_value();
  return text_.substr(first, at_ - first);
}

template <class Number>
std::vector<Number> UsdText::read_numbers() {
  std::vector<Number> result;
  int depth = 0;
  do {
    if (!next()) fail("the file ends within numbers");
    const char c = peek();
    if (c == '[' || c == '(') {
      ++depth;
      ++at_;
    } else if (c == ']' || c == ')') {
      if (--depth < 0) fail("expected a number");
      ++at_;
    } else if (c == ',' && depth > 0) {
      ++at_;
    } else {
      Number value;
      const char* end = nullptr;
      const std::string_view rest = text_.substr(at_);
      if constexpr (std::is_same_v<Number, float>) {
        const Decimal decimal = parse_decimal(rest);
        value = decimal.value;
        end = decimal.end;
      } else {
        // As std::from_chars(), which browsers' standard library lacks for floating point.
        const auto [stop, error] =
            fast_float::from_chars(rest.data(), rest.data() + rest.size(), value);
        if (error == std::errc()) end = stop;
      }
      if (!end || end == rest.data()) fail("expected a number");
      at_ += std::size_t(end - rest.data());
      if (!make_room(result, 1, budget_))
        throw InputError({file_}, budget_.refusal("the numbers of an attribute"), max_memory_hint);
      result.push_back(value);
    }
  } while (depth > 0);
  return result;
}

std::vector<double> UsdText::numbers() { return read_numbers<double>(); }
std::vector<float> UsdText::floats() { return read_numbers<float>(); }

}  // namespace tureen
