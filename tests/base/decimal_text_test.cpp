#include "base/decimal_text.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace tureen {
namespace decimal_text_test {

TEST(Counted, HasTheNounInItsNumber) {
  EXPECT_EQ(counted(0, "step"), "0 steps");
  EXPECT_EQ(counted(1, "step"), "1 step");
  EXPECT_EQ(counted(33417, "step"), "33,417 steps");
}

TEST(DecimalText, HasSignificantDigitsOrPlaces) {
  EXPECT_EQ(short_decimal(0.75, 4), "0.75");
  EXPECT_EQ(short_decimal(100, 4), "100");
  EXPECT_EQ(short_decimal(-1.23456e-5, 3), "-1.23e-05");
  EXPECT_EQ(fixed_decimal(0.5, 2), "0.50");
  EXPECT_EQ(fixed_decimal(41.6, 0), "42");
}

TEST(DecimalText, HoldsEveryDouble) {
  EXPECT_EQ(fixed_decimal(-std::numeric_limits<double>::max(), 9).size(), 320u);
  EXPECT_EQ(short_decimal(std::numeric_limits<double>::infinity(), 9), "inf");
  EXPECT_EQ(fixed_decimal(std::numeric_limits<double>::quiet_NaN(), 2), "nan");
}

TEST(DurationText, IsShortAndRounded) {
  EXPECT_EQ(duration_text(0.4), "0 s");
  EXPECT_EQ(duration_text(59.4), "59 s");
  EXPECT_EQ(duration_text(59.6), "1 min 0 s");
  EXPECT_EQ(duration_text(425), "7 min 5 s");
  EXPECT_EQ(duration_text(3599.7), "1 h 0 min");
  EXPECT_EQ(duration_text(90061), "25 h 1 min");
}

}  // namespace decimal_text_test
}  // namespace tureen
