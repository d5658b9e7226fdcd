#include "base/decimal_text.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace tureen {
namespace decimal_text_test {

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

}  // namespace decimal_text_test
}  // namespace tureen
