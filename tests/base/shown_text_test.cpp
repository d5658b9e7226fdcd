#include "base/shown_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/utf8.hpp"
#include "tests/support/errors.hpp"

namespace tureen {
namespace shown_text_test {

using test::Names;
using testing::EndsWith;
using testing::StartsWith;

TEST(ShownText, LeavesWhatTerminalsShow) {
  EXPECT_EQ(shown_text(""), "");
  for (const char* text : {"an image.png", "C:\\scenes\\new",
                           "Sch\u00fcssel, \u4e09\u89d2, "
                           "\U0001F372"})
    EXPECT_EQ(shown_text(text), text);
}

TEST(ShownText, WritesOutWhatSteersATerminal) {
  EXPECT_EQ(shown_text("a\nb\r\tc"), "a\\nb\\r\\tc");
  EXPECT_EQ(shown_text("\x1b[2J\x7f\a"), "\\u001b[2J\\u007f\\u0007");
  EXPECT_EQ(shown_text(std::string_view("a\0b", 3)), "a\\u0000b");
  EXPECT_EQ(shown_text("\xc2\x9b"
                       "2J"),
            "\\u009b2J")
      << "an escape sequence in one character";
  EXPECT_EQ(shown_text("\u2028\u202e\u2066"), "\\u2028\\u202e\\u2066");
  EXPECT_EQ(shown_text("\ufffe\uffff"), "\\ufffe\\uffff") << "not characters";
}

TEST(ShownText, WritesOutBytesThatAreNoUtf8) {
  EXPECT_EQ(shown_text("\xff\xfe.off"), "\\xff\\xfe.off");
  EXPECT_EQ(shown_text("\x9b"
                       "2J"),
            "\\x9b2J");
  EXPECT_EQ(shown_text("\xe2\x82"), "\\xe2\\x82") << "truncated";
  EXPECT_EQ(shown_text("\xc0\x8a"), "\\xc0\\x8a") << "an overlong line feed";
}

TEST(ShownText, OfALongLineShowsBeginningAndEnd) {
  const std::string line = "x.glb: '" + std::string(1'000'000, 'a') + "' is no name";
  EXPECT_THAT(shown_line(line), StartsWith("x.glb: 'aaa"));
  EXPECT_THAT(shown_line(line), EndsWith("aaa' is no name"));
  EXPECT_THAT(shown_line(line), Names(999020));
  EXPECT_LT(shown_line(line).size(), 1100u);
  EXPECT_EQ(shown_line(std::string(1000, 'a')), std::string(1000, 'a'));
}

TEST(ShownText, CutsNoCharacterInTwo) {
  for (std::size_t shift = 0; shift < 4; ++shift) {
    std::string line(shift, 'a');
    for (int i = 0; i < 1000; ++i) line += "\U0001F372";
    const std::string shown = shown_line(line);
    for (std::size_t at = 0; at < shown.size();) {
      const std::size_t length = utf8_character(shown, at).length;
      ASSERT_GT(length, 0u) << shift << ", byte " << at;
      at += length;
    }
  }
}

}  // namespace shown_text_test
}  // namespace tureen
