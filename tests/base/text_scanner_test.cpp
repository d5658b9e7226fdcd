#include "base/text_scanner.hpp"

#include <gtest/gtest.h>

#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "tests/formats/format_testing.hpp"

namespace tureen {
namespace text_scanner_test {

using test::error_of;
using test::ErrorAt;
using test::input_of;

TEST(TextScanner, ReadsLineByLine) {
  const std::string text = "  word 1.5\t-7 # comment\r\n\n\r# only a comment\n3\v4\f5";
  Input input = input_of(text);
  TextScanner scanner(input, {.comment = '#'});
  EXPECT_EQ(scanner.read_word("a word"), "word");
  EXPECT_EQ(scanner.read_float("a float"), 1.5f);
  EXPECT_FALSE(scanner.at_line_end());
  EXPECT_EQ(scanner.read_integer("an integer"), -7);
  EXPECT_TRUE(scanner.at_line_end());
  EXPECT_TRUE(scanner.next_content());
  EXPECT_EQ(scanner.line(), 5u);
  EXPECT_EQ(scanner.read_integer("three", 3, 3), 3);
  EXPECT_EQ(scanner.read_integer("four"), 4);
  EXPECT_EQ(scanner.remaining(), 2u);
  EXPECT_EQ(scanner.read_integer("five"), 5);
  EXPECT_TRUE(scanner.at_line_end());
  EXPECT_FALSE(scanner.next_line());
  EXPECT_FALSE(scanner.next_content());
}

TEST(TextScanner, EndsALineWithACommentThatEndsTheText) {
  const std::string text = "a # b";
  Input input = input_of(text);
  TextScanner scanner(input, {.comment = '#'});
  EXPECT_EQ(scanner.read_word("a word"), "a");
  EXPECT_TRUE(scanner.at_line_end());
  EXPECT_FALSE(scanner.next_line());
}

TEST(TextScanner, RefusesWordsThatAreTooLong) {
  const std::string longest(TextScanner::max_word, 'w');
  const std::string line = longest + "\n";
  Input input = input_of(line);
  EXPECT_EQ(TextScanner(input).read_word("a word"), longest);
  const std::string text = "\n" + longest + "w";
  Input longer = input_of(text);
  TextScanner scanner(longer);
  EXPECT_TRUE(scanner.next_line());
  EXPECT_TRUE(error_of([&] { scanner.read_word("a word"); }));
}

TEST(TextScanner, CountsEveryKindOfLineBreak) {
  const std::string text = "a\nb\rc\r\nd\n\re";
  Input input = input_of(text);
  TextScanner scanner(input);
  std::vector<std::pair<std::string, std::uint64_t>> words;
  while (scanner.next_content()) {
    std::string word = scanner.read_word("a word");
    words.emplace_back(word, scanner.line());
  }
  const std::vector<std::pair<std::string, std::uint64_t>> expected{
      {"a", 1}, {"b", 2}, {"c", 3}, {"d", 4}, {"e", 6}};
  EXPECT_EQ(words, expected);
}

TEST(TextScanner, NamesLineAndReason) {
  const auto message = [](const std::string& text, auto&& read) {
    Input input = input_of(text);
    TextScanner scanner(input, {.comment = '#', .first_line = 10});
    return error_of([&] { read(scanner); });
  };
  const auto number = [](TextScanner& s) { s.read_float("an x"); };
  EXPECT_THAT(message("abc", number), ErrorAt("test.file:10", "abc"));
  EXPECT_THAT(message("1.5x 2", number), ErrorAt("test.file:10", "1.5x"));
  EXPECT_THAT(message(" \n1", number), ErrorAt("test.file:10", "an x"));
  EXPECT_THAT(message("#1", number), ErrorAt("test.file:10", "an x"));
  EXPECT_THAT(message(std::string("\0", 1), number), ErrorAt("test.file:10", "an x"));
  EXPECT_THAT(message(std::string(2000, '1'), number), ErrorAt("test.file:10", "an x", 1024));
  EXPECT_THAT(message("\x01\xff", number), ErrorAt("test.file:10", ".."));
  EXPECT_THAT(message("\n1.5", [](TextScanner& s) { s.next_line(), s.read_integer("a count"); }),
              ErrorAt("test.file:11", "1.5"));
  EXPECT_THAT(message("99999999999999999999", [](TextScanner& s) { s.read_integer("a count"); }),
              ErrorAt("test.file:10", "99999999999999999999"));
  EXPECT_THAT(message("-1", [](TextScanner& s) { s.read_integer("a count", 0, 9); }),
              ErrorAt("test.file:10", -1, 9));
  EXPECT_THAT(message("1 2 3", [](TextScanner& s) { s.read_integer("x"), s.expect_line_end("x"); }),
              ErrorAt("test.file:10", 2));
}

TEST(TextScanner, ReadsTheRestOfALineAndNoByteOrderMark) {
  const std::string text =
      "\xef\xbb\xbf"
      "7  a  b \t\r\n\r\n x\n" +
      std::string(2000, 'y');
  Input input = input_of(text);
  TextScanner scanner(input);
  EXPECT_EQ(scanner.read_integer("a number"), 7);
  EXPECT_EQ(scanner.read_line(), "a  b");
  EXPECT_TRUE(scanner.next_line());
  EXPECT_EQ(scanner.read_line(), "");
  EXPECT_TRUE(scanner.next_line());
  EXPECT_EQ(scanner.read_line(), "x");
  EXPECT_TRUE(scanner.next_line());
  EXPECT_THAT(error_of([&] { scanner.read_line(); }), ErrorAt("test.file:4", 1024));
  // A mark in the middle is text.
  const std::string middle = "x\xef\xbb\xbf";
  Input later = input_of(middle);
  EXPECT_EQ(TextScanner(later).read_line(), "x\xef\xbb\xbf");
}

TEST(TextScanner, SeesTheSameNumbersAsAStreamAcrossWindows_seed4) {
  // Blanks, comments and line breaks of random length put window borders at all positions.
  std::mt19937 random(4);
  std::string text;
  std::vector<float> expected;
  std::size_t lines = 1;
  while (text.size() < 5 * TextScanner::window) {
    const int kind = int(random() % 40);
    if (kind == 0) {
      text += "#" + std::string(random() % 3000, '9') + "\r\n";
      ++lines;
    } else if (kind == 1) {
      text += std::string(random() % 3000, ' ');
    } else if (kind == 2) {
      text += "\n";
      ++lines;
    }
    expected.push_back(float(int(random())) / 1024.0f);
    text += " " + float_text(expected.back());
  }
  text += std::string(2 * TextScanner::window, ' ');
  Input input = input_of(text);
  TextScanner scanner(input, {.comment = '#'});
  std::vector<float> got;
  while (scanner.next_content()) got.push_back(scanner.read_float("a number"));
  EXPECT_EQ(got, expected);
  EXPECT_EQ(scanner.line(), lines);
  EXPECT_EQ(scanner.remaining(), 0u);
}

}  // namespace text_scanner_test
}  // namespace tureen
