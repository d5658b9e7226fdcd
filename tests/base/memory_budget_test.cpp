#include "base/memory_budget.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "base/error.hpp"

namespace tureen {
namespace memory_budget_test {

TEST(MemorySize, IsParsedInEveryUnit) {
  const std::uint64_t k = 1024;
  EXPECT_EQ(parse_memory_size("1"), 1u);
  EXPECT_EQ(parse_memory_size("17 bytes"), 17u);
  EXPECT_EQ(parse_memory_size("3k"), 3 * k);
  EXPECT_EQ(parse_memory_size("512MiB"), 512 * k * k);
  EXPECT_EQ(parse_memory_size("1.5g"), 3 * k * k * k / 2);
  EXPECT_EQ(parse_memory_size("4  GB"), 4 * k * k * k);
  EXPECT_EQ(parse_memory_size("2TiB"), 2 * k * k * k * k);
  EXPECT_EQ(parse_memory_size("16777217"), 16777217u);  // more digits than a float has
  EXPECT_EQ(parse_memory_size("4611686018427387904"), std::uint64_t(1) << 62);
}

TEST(MemorySize, IsRefusedOtherwise) {
  for (const char* text : {"", "0", "0.5", "-1", "big", "5 parsecs", "1e30", "nan", "8GiBs",
                           "4611686018427390000", "4194305 TiB"})
    EXPECT_THROW(parse_memory_size(text), UsageError) << text;
}

TEST(MemorySize, HasFourDigitsAsText) {
  EXPECT_EQ(memory_size_text(1), "1 byte");
  EXPECT_EQ(memory_size_text(1023), "1,023 bytes");
  EXPECT_EQ(memory_size_text(1024), "1 KiB");
  EXPECT_EQ(memory_size_text(1536 * 1024), "1.5 MiB");
  EXPECT_EQ(memory_size_text(default_max_memory), "4 GiB");
  EXPECT_EQ(memory_size_text(std::uint64_t(5) << 50), "5120 TiB");
}

TEST(MemoryBudget, CountsWhatIsTakenAndGivenBack) {
  MemoryBudget budget(100);
  MemoryBudget copy = budget;  // shares the count
  EXPECT_TRUE(budget.take(10, 8));
  EXPECT_FALSE(copy.take(3, 7));
  EXPECT_EQ(copy.taken(), 80u);
  EXPECT_TRUE(copy.take(4, 5));
  EXPECT_EQ(budget.left(), 0u);
  EXPECT_FALSE(budget.take(UINT64_MAX, 16));
  budget.give_back(60);
  EXPECT_EQ(copy.taken(), 40u);
  {
    PassingMemory passing(budget);
    EXPECT_TRUE(budget.take(50));
    passing.keep(20);
  }
  EXPECT_EQ(budget.taken(), 60u);
}

TEST(MemoryBudget, RoomIsDoubledWhereItAllows) {
  MemoryBudget budget(1000);
  std::vector<std::uint32_t> values(50);
  ASSERT_TRUE(budget.take(50, 4));
  ASSERT_TRUE(make_room(values, 1, budget));
  EXPECT_EQ(values.capacity(), 100u);
  EXPECT_EQ(budget.taken(), 400u);
  values.resize(100);
  // 200 would take 800 of the 600 bytes that are left, 110 takes 440.
  ASSERT_TRUE(make_room(values, 10, budget));
  EXPECT_EQ(values.capacity(), 110u);
  values.resize(110);
  EXPECT_FALSE(make_room(values, 50, budget));
  EXPECT_EQ(budget.taken(), 440u);
}

}  // namespace memory_budget_test
}  // namespace tureen
