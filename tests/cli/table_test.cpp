// The tables of the terminal.
#include "cli/table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tureen::cli {
namespace table_test {

using testing::ElementsAre;

TEST(Table, ColumnsAreAsWideAsTheirWidestCell) {
  Table table({"view", "dB", "<meaning"});
  table.row({"a", "100.00", "equal"});
  table.row({"näher", "–", ""});
  table.row({"c"});
  EXPECT_THAT(table.lines(), ElementsAre("view       dB  meaning",  //
                                         "a      100.00  equal",    //
                                         "näher       –",           //
                                         "c"))
      << "letters of several bytes have width 1; no line ends in spaces";
}

TEST(Table, RemarksWidenNoColumn) {
  Table table({"name", "ms"});
  table.row({"tureen", "1.50"});
  table.remark("visibility 0.5 ms");
  EXPECT_THAT(table.lines(),
              ElementsAre("name      ms", "tureen  1.50", "        visibility 0.5 ms"));
}

TEST(Table, HasNoHeadingLineWhereNoColumnHasAHeading) {
  Table table({"", "<"});
  table.row({"up", "(0, 0, 1)"});
  table.row({"", "more"});
  EXPECT_THAT(table.lines(), ElementsAre("up  (0, 0, 1)", "    more"));
}

TEST(Table, MillisecondsHaveThreeDigitsDownToAMicrosecond) {
  EXPECT_EQ(ms_text(0.01234), "0.012");
  EXPECT_EQ(ms_text(0.1234), "0.123");
  EXPECT_EQ(ms_text(7.891), "7.89");
  EXPECT_EQ(ms_text(52), "52.0");
}

}  // namespace table_test
}  // namespace tureen::cli
