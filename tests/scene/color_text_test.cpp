#include "scene/document/color_text.hpp"

#include <gmock/gmock.h>

#include "base/error.hpp"

namespace tureen::test {

TEST(ColorText, IsANameOrHexadecimalOrNumbers) {
  EXPECT_EQ(color_text(parse_color("wheat")), "#F5DEB3");
  EXPECT_EQ(color_text(parse_color("aliceblue")), "#F0F8FF");
  EXPECT_EQ(color_text(parse_color("yellowgreen")), "#9ACD32");
  EXPECT_EQ(parse_color("lightslategrey"), parse_color("lightslategray"));
  EXPECT_EQ(color_text(parse_color("#ff8000")), "#FF8000");
  EXPECT_EQ(parse_color("FF8000"), parse_color("#ff8000"));
  EXPECT_EQ(parse_color("0,0.5,1"), glm::vec3(0, 0.5f, 1));
}

TEST(ColorText, OfAnotherFormIsRefused) {
  for (const char* bad : {"", "#", "#ff800", "#ff80000", "#ggffff", "0,0.5", "0,0.5,1.5", "0,0,0 ",
                          "0,0,nan", "wheat ", "transparent"})
    EXPECT_THROW(parse_color(bad), UsageError) << bad;
  try {
    parse_color("whaet");
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("'whaet' is not a colour"));
    EXPECT_THAT(error.what(), testing::HasSubstr("did you mean wheat?"));
  }
}

}  // namespace tureen::test
