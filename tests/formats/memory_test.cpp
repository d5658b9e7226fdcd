// Memory limits of readers: amounts in text, the count, and every reader under a limit.
#include <gmock/gmock.h>

#include <cstring>

#include "base/memory_budget.hpp"
#include "image/decoder_memory.hpp"
#include "image/png.hpp"
#include "tests/formats/format_testing.hpp"
#include "tests/formats/memory_limit.hpp"
#include "tests/fuzz/fixtures.hpp"
#include "tests/fuzz/targets.hpp"

namespace tureen {
namespace memory_test {

using test::MemoryLimit;
using test::Names;

TEST(MemorySize, IsReadAsPeopleWriteIt) {
  EXPECT_EQ(parse_memory_size("1"), 1u);
  EXPECT_EQ(parse_memory_size("4294967297"), 4294967297u);
  for (const char* text : {"4GB", "4 GB", "4g", "4GiB", "4096MB", "4194304kB", "4294967296 bytes"})
    EXPECT_EQ(parse_memory_size(text), std::uint64_t(1) << 32) << text;
  EXPECT_EQ(parse_memory_size("1.5kB"), 1536u);
  EXPECT_EQ(parse_memory_size("2TB"), std::uint64_t(2) << 40);
  for (const char* text :
       {"", "GB", "-1GB", "0", "0.5", "nan", "inf GB", "4 G B", "4XB", "4GBs", "9999999TB", "1e30"})
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

TEST(DecoderMemory, IsZeroAndBounded) {
  MemoryBudget budget(2000);
  EXPECT_EQ(decoder_memory::allocate(1), nullptr) << "outside any scope";
  const decoder_memory::Scope scope(budget, 1500);
  auto* block = static_cast<unsigned char*>(decoder_memory::allocate(500));
  ASSERT_NE(block, nullptr);
  for (int i = 0; i < 500; ++i) ASSERT_EQ(block[i], 0);
  std::memset(block, 7, 500);
  // While it reallocates, the old and the new block both exist.
  EXPECT_EQ(decoder_memory::reallocate(block, 1001), nullptr);
  EXPECT_TRUE(scope.beyond_limit());
  EXPECT_EQ(decoder_memory::allocate(1), nullptr) << "after one rejection, every allocation fails";
  decoder_memory::release(block);
  EXPECT_EQ(budget.taken(), 0u);
}

TEST(DecoderMemory, MovesWhatIsThere) {
  MemoryBudget budget(2000);
  {
    const decoder_memory::Scope scope(budget, 10000);
    auto* block = static_cast<unsigned char*>(decoder_memory::allocate(100));
    std::memset(block, 7, 100);
    block = static_cast<unsigned char*>(decoder_memory::reallocate(block, 400));
    ASSERT_NE(block, nullptr);
    for (int i = 0; i < 100; ++i) ASSERT_EQ(block[i], 7);
    EXPECT_EQ(budget.taken(), 400u);
    EXPECT_EQ(decoder_memory::allocate(1601), nullptr);
    EXPECT_TRUE(scope.beyond_budget());
    decoder_memory::release(block);
  }
  EXPECT_EQ(budget.taken(), 0u);
}

TEST(DecoderMemory, OfAnImageKeepsTheImageAlone) {
  MemoryBudget budget;
  const Image8 image(30, 20, glm::u8vec4(1, 2, 3, 255));
  decode_image(encode_png(image), "a.png", budget);
  EXPECT_EQ(budget.taken(), 30u * 20 * 4);
}

/// Whether the fixture is readable under this limit. Any error except the memory error fails the
/// test.
bool is_read(const fuzz::Fixture& fixture, const fuzz::Target& target, std::uint64_t limit) {
  const MemoryLimit scoped(limit);
  try {
    target.read(fixture.bytes);
    return true;
  } catch (const InputError& error) {
    EXPECT_EQ(error.hint().rfind(max_memory_hint, 0), 0u) << fixture.name << " at " << limit;
    EXPECT_FALSE(error.place().file.empty()) << fixture.name;
    return false;
  }
}

TEST(MaxMemory, EveryReaderKeepsToItAndSaysSo) {
  for (const fuzz::Fixture& fixture : fuzz::fixtures())
    for (const fuzz::Target& target : fuzz::targets) {
      if (fixture.target != target.name) continue;
      SCOPED_TRACE(fixture.target + "/" + fixture.name);
      EXPECT_FALSE(is_read(fixture, target, 1));
      // There is one limit: reading fails below it, and succeeds from there on.
      std::uint64_t refused = 1, read = default_max_memory;
      while (read - refused > 1) {
        const std::uint64_t middle = (read + refused) / 2;
        (is_read(fixture, target, middle) ? read : refused) = middle;
      }
      // A fixture has a few kilobytes; an image decoder allocates tables of 1 MB.
      EXPECT_LT(read, 8u << 20);
      for (const std::uint64_t limit : {refused / 3, refused / 2, refused - 1})
        EXPECT_FALSE(is_read(fixture, target, limit));
      for (const std::uint64_t limit : {read + 1, 2 * read, 3 * read})
        EXPECT_TRUE(is_read(fixture, target, limit));
    }
}

}  // namespace memory_test
}  // namespace tureen
