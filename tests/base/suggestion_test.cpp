#include "base/suggestion.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace tureen {
namespace suggestion_test {

TEST(EditDistance, CountsEachKindOfMistake) {
  EXPECT_EQ(edit_distance("", ""), 0);
  EXPECT_EQ(edit_distance("splat", "splat"), 0);
  EXPECT_EQ(edit_distance("", "abc"), 3);
  EXPECT_EQ(edit_distance("abc", ""), 3);
  EXPECT_EQ(edit_distance("splat", "spat"), 1);    // deletion
  EXPECT_EQ(edit_distance("splat", "splats"), 1);  // insertion
  EXPECT_EQ(edit_distance("splat", "spl4t"), 1);   // substitution
  EXPECT_EQ(edit_distance("splat", "slpat"), 1);   // swap
  EXPECT_EQ(edit_distance("splat", "psalt"), 2);   // two swaps
  EXPECT_EQ(edit_distance("ab", "ba"), 1);         // swap of the first two
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
  EXPECT_EQ(edit_distance("abcd", "badc"), 2);  // two swaps
}

TEST(Nearest, IsTheNameWithTheFewestMistakes) {
  const std::vector<std::string> known{"render", "report", "View", "view", "train"};
  EXPECT_EQ(nearest("rendre", known), "render");
  EXPECT_EQ(nearest("rport", known), "report");
  EXPECT_EQ(nearest("VIEW", known), "View");
  EXPECT_EQ(nearest("vIEW", known), "view");  // three letters in another case; of View, four
  EXPECT_EQ(nearest("vieW", known), "view");
  EXPECT_EQ(nearest("TRAIN", known), "train");
  EXPECT_EQ(nearest("tra", known), "train");  // its beginning
  EXPECT_EQ(nearest("xyzzyx", known), "");    // more than a third is wrong
  EXPECT_EQ(nearest("vw", {}), "");
  EXPECT_EQ(nearest("", known), "");
  EXPECT_EQ(did_you_mean("rendre", known), "did you mean render?");
  EXPECT_EQ(did_you_mean("xyzzyx", known), "");
}

}  // namespace suggestion_test
}  // namespace tureen
