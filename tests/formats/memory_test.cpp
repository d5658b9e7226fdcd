// Memory limits of readers: decoders, and every reader under a limit.
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
    EXPECT_FALSE(error.position().file.empty()) << fixture.name;
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
