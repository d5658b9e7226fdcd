#include "base/base64.hpp"

#include <gtest/gtest.h>

#include <span>
#include <string>
#include <string_view>

namespace tureen {
namespace base64_test {

std::string encoded(std::string_view text) {
  return cli::base64(std::as_bytes(std::span(text.data(), text.size())));
}

/// The test vectors of RFC 4648, section 10, and all 64 digits.
TEST(Base64, HasKnownValues) {
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
  EXPECT_EQ(encoded("fooba"), "Zm9vYmE=");
  std::string digits;
  for (unsigned digit = 0; digit < 64; digit += 4) {
    const unsigned three = digit << 18 | (digit + 1) << 12 | (digit + 2) << 6 | (digit + 3);
    for (const int shift : {16, 8, 0}) digits += char(three >> shift & 255);
  }
  EXPECT_EQ(encoded(digits), "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/");
}

}  // namespace base64_test
}  // namespace tureen
