#include "base/html_escape.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tureen {
namespace html_escape_test {

using testing::StartsWith;

TEST(HtmlEscaped, LeavesNothingThatIsMarkup) {
  EXPECT_EQ(html_escaped("a < b > c & \"d\" 'e'"),
            "a &lt; b &gt; c &amp; &quot;d&quot; &#39;e&#39;");
  EXPECT_EQ(html_escaped("\xc3\xa9\xe2\x82\xac\xf0\x9f\x8d\xb2\n"),
            "\xc3\xa9\xe2\x82\xac\xf0\x9f\x8d\xb2\n");
}

TEST(HtmlEscaped, WhatIsNoTextIsReplaced) {
  const std::string replacement = "\xef\xbf\xbd";
  for (const std::string bad :
       {"\x01", "\x7f", "\x80", "\xff", "\xc3", "\xe2\x82", "\xc0\xaf", "\xed\xa0\x80",
        "\xf4\x90\x80\x80", "\xef\xbf\xbe", "\xf8\x88\x80\x80\x80"}) {
    const std::string escaped = html_escaped("a" + bad + "b");
    EXPECT_THAT(escaped, StartsWith("a" + replacement)) << bad;
    EXPECT_EQ(escaped.back(), 'b');
    EXPECT_EQ(html_escaped(escaped), escaped) << "the result is valid text";
  }
  EXPECT_EQ(html_escaped(std::string("a\0b", 3)), "a" + replacement + "b");
}

}  // namespace html_escape_test
}  // namespace tureen
