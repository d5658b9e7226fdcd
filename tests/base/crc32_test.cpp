#include "base/crc32.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <vector>

namespace tureen {

TEST(Crc32, IsThatOfZlibForEveryLength) {
  std::vector<std::byte> bytes;
  for (unsigned size = 0; size < 40; ++size) {
    EXPECT_EQ(crc32_of(bytes), crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), size));
    bytes.push_back(std::byte(37 * size + 5));
  }
}

}  // namespace tureen
