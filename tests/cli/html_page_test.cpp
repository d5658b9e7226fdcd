#include "cli/html_page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <random>

#include "formats/png.hpp"
#include "soup/image.hpp"
#include "support/markup.hpp"

namespace tureen::cli {
namespace {

using test::check_markup;
using test::Markup;
using testing::Each;
using testing::HasSubstr;
using testing::Not;
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
    EXPECT_EQ(html_escaped(escaped), escaped) << "it is text now";
  }
  EXPECT_EQ(html_escaped(std::string("a\0b", 3)), "a" + replacement + "b");
}

/// With every kind of part, each of them given `text`.
HtmlPage page_of(const std::string& text) {
  HtmlPage page(text);
  page.section(text);
  page.paragraph(text);
  page.list({text, text});
  page.list({});
  page.command(text);
  page.fold(text);
  page.facts({{text, text}, {"machine", text}});
  page.fold_end();
  page.table({{text, HtmlPage::Column::text}, {"ms"}}, {{text, "1.5"}, {"b", text}});
  page.drawing("<svg xmlns=\"http://www.w3.org/2000/svg\"></svg>", text);
  const std::array<std::byte, 4> bytes{std::byte{0}, std::byte{0xff}, std::byte{0x10},
                                       std::byte{9}};
  page.picture(bytes, text);
  return page;
}

TEST(HtmlPage, IsWellFormedWhateverTheTextsAre) {
  const unsigned seed = 7;
  SCOPED_TRACE(testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  for (int round = 0; round < 200; ++round) {
    std::string text = "<script>alert(\"1\")</script> & </table> 'x' --> ]]>";
    for (char& c : text)
      if (random() % 8 == 0) c = char(random());
    const Markup markup = check_markup(page_of(text).text());
    EXPECT_EQ(markup.defect, "");
    EXPECT_THAT(markup.elements, Not(testing::Contains("script")));
  }
}

TEST(HtmlPage, NeedsNothingBesideIt) {
  const std::string html = page_of("text").text();
  const Markup markup = check_markup(html);
  EXPECT_THAT(markup.links, Each(StartsWith("data:")));
  EXPECT_THAT(markup.elements, Not(testing::Contains("link")));
  EXPECT_THAT(html, HasSubstr("prefers-color-scheme:dark"));
  EXPECT_THAT(html, HasSubstr("width=device-width"));
  // The bytes 00 ff 10 09 in base64, with the padding that a last single byte needs.
  EXPECT_THAT(markup.links, testing::Contains("data:image/png;base64,AP8QCQ=="));
}

TEST(Markup, SaysWhatIsWrong) {
  for (const char* bad :
       {"<a>", "<a></b>", "<a b=c></a>", "<a b='1' b='2'></a>", "<a>&x;</a>", "<a b=\"<\"></a>",
        "<a b=\"1></a>", "<a></a><b></b>", "x<a></a>", "< a></a>"})
    EXPECT_NE(check_markup(bad).defect, "") << bad;
  EXPECT_EQ(check_markup("<?xml version='1'?>\n<a b = 'c'><d/>&amp;</a>\n").defect, "");
}

}  // namespace
}  // namespace tureen::cli
