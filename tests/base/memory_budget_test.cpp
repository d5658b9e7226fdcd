// Amounts of memory as text, and the count of a read operation.
#include "base/memory_budget.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "tests/support/errors.hpp"

namespace tureen {
namespace memory_budget_test {

using test::Names;

TEST(MemorySize, IsReadAsPeopleWriteIt) {
  EXPECT_EQ(parse_memory_size("1"), 1u);
  EXPECT_EQ(parse_memory_size("4294967297"), 4294967297u);
  for (const char* text : {"4GB", "4 GB", "4g", "4GiB", "4096MB", "4194304kB", "4294967296 bytes"})
    EXPECT_EQ(parse_memory_size(text), std::uint64_t(1) << 32) << text;
  EXPECT_EQ(parse_memory_size("1.5kB"), 1536u);
  EXPECT_EQ(parse_memory_size("2TB"), std::uint64_t(2) << 40);
  EXPECT_EQ(parse_memory_size("512MiB"), std::uint64_t(512) << 20);
  EXPECT_EQ(parse_memory_size("16777217"), 16777217u);  // more digits than a float has
  EXPECT_EQ(parse_memory_size("4611686018427387904"), std::uint64_t(1) << 62);
  for (const char* text : {"", "GB", "-1GB", "0", "0.5", "nan", "inf GB", "4 G B", "4XB", "4GBs",
                           "9999999TB", "1e30", "4611686018427390000", "4194305 TiB"})
    EXPECT_THROW(parse_memory_size(text), UsageError) << text;
}

TEST(MemorySize, IsSaidAsItIsRead) {
  EXPECT_EQ(memory_size_text(0), "0 bytes");
  EXPECT_EQ(memory_size_text(1), "1 byte");
  EXPECT_EQ(memory_size_text(1023), "1,023 bytes");
  EXPECT_EQ(memory_size_text(1536), "1.5 KiB");
  EXPECT_EQ(memory_size_text(default_max_memory), "4 GiB");
  EXPECT_EQ(memory_size_text(std::uint64_t(3) << 40), "3 TiB");
}

TEST(MemoryBudget, CountsOverAllOfItsCopiesAndNeverOverflows) {
  MemoryBudget budget(100), copy = budget;
  EXPECT_TRUE(budget.take(10, 4));
  EXPECT_TRUE(copy.take(15, 4));
  EXPECT_EQ(budget.left(), 0u);
  EXPECT_FALSE(budget.take(1));
  EXPECT_EQ(copy.taken(), 100u);
  copy.give_back(60);
  EXPECT_EQ(budget.left(), 60u);
  // In 64 bits, these products and sums overflow to 0 or to small values.
  for (const auto& [elements, each] :
       {std::pair(std::uint64_t(1) << 62, std::size_t(4)),
        std::pair(~std::uint64_t(0), std::size_t(1)), std::pair(std::uint64_t(2), ~std::size_t(0))})
    EXPECT_FALSE(budget.take(elements, each));
  EXPECT_TRUE(budget.take(0, 8));
  EXPECT_EQ(budget.taken(), 40u);
  EXPECT_THAT(budget.refusal("it"), Names("it", 100));
}

TEST(MemoryBudget, GivesBackWhatOnlyPassed) {
  MemoryBudget budget(100);
  ASSERT_TRUE(budget.take(10));
  {
    PassingMemory passing(budget);
    ASSERT_TRUE(budget.take(50));
    passing.keep(20);
  }
  EXPECT_EQ(budget.taken(), 30u);
  { const PassingMemory nothing(budget); }
  EXPECT_EQ(budget.taken(), 30u);
}

TEST(MemoryBudget, CountsVectorsWhileTheyGrow) {
  MemoryBudget budget(1000);
  std::vector<std::uint32_t> values;
  ASSERT_TRUE(make_room(values, 10, budget));
  EXPECT_EQ(values.capacity(), 10u);
  EXPECT_EQ(budget.taken(), 40u);
  values.resize(10);
  ASSERT_TRUE(make_room(values, 1, budget));
  EXPECT_EQ(values.capacity(), 20u);
  EXPECT_EQ(budget.taken(), 80u);
  // 920 bytes more than 80 would fit, but the old elements need their 80 bytes until they are
  // moved.
  EXPECT_FALSE(make_room(values, 230, budget));
  EXPECT_EQ(values.capacity(), 20u);
  EXPECT_EQ(budget.taken(), 80u);
  EXPECT_TRUE(make_room(values, 220, budget));
  EXPECT_EQ(budget.taken(), 920u);
  EXPECT_FALSE(make_room(values, ~std::uint64_t(0), budget));
}

}  // namespace memory_budget_test
}  // namespace tureen
