#include "formats/archive/zip_archive.hpp"

#include <gmock/gmock.h>

#include "tests/formats/torch_fixture.hpp"
#include "tests/formats/truncation.hpp"
#include "tests/support/errors.hpp"

namespace tureen {
namespace zip_archive_test {

using test::as_bytes;
using test::error_of;
using test::ErrorAt;
using test::Refusal;
using test::ZipFixture;

std::string text_of(ZipArchive& zip, const ZipEntry& entry, std::uint64_t offset,
                    std::size_t count) {
  std::string text(count, '?');
  zip.read(entry, offset, std::as_writable_bytes(std::span(text)));
  return text;
}

std::optional<Refusal> refusal(const std::string& bytes) {
  return error_of([&] {
    ZipArchive zip(Input::memory("a.zip", as_bytes(bytes)));
    for (const ZipEntry& entry : zip.entries()) zip.read_all(entry, 1u << 20);
  });
}

/// The second entry inflates to more than 128 KiB, which is several buffers.
ZipFixture sample(bool zip64) {
  std::string numbers;
  for (int i = 0; i < 30000; ++i) numbers += std::to_string(i) + ' ';
  return {{{"b/stored", "0123456789"}, {"a/deflated", numbers, true}, {"c/empty", ""}}, zip64};
}

class Zip : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(OrdinaryAnd64, Zip, ::testing::Bool());

TEST_P(Zip, EntriesAreReadWholeAndByRange) {
  const ZipFixture fixture = sample(GetParam());
  const std::string bytes = fixture.bytes();
  ZipArchive zip(Input::memory("a.zip", as_bytes(bytes)));
  ASSERT_EQ(zip.entries().size(), 3u);
  EXPECT_EQ(zip.find("b"), nullptr);
  const ZipEntry* stored = zip.find("b/stored");
  const ZipEntry* deflated = zip.find("a/deflated");
  ASSERT_TRUE(stored && deflated && zip.find("c/empty"));
  EXPECT_EQ(text_of(zip, *stored, 0, 10), "0123456789");
  EXPECT_EQ(text_of(zip, *stored, 7, 3), "789");
  const std::string& numbers = fixture.entries[1].content;
  ASSERT_GT(numbers.size(), 131072u);
  EXPECT_EQ(text_of(zip, *deflated, 0, numbers.size()), numbers);
  EXPECT_EQ(text_of(zip, *deflated, 100001, 65), numbers.substr(100001, 65));
  EXPECT_TRUE(zip.read_all(*zip.find("c/empty"), 0).empty());
  EXPECT_THROW(zip.read_all(*stored, 9), InputError);
}

TEST(Zip, WhatIsRefusedIsNamed) {
  EXPECT_THAT(refusal("PK"), ErrorAt("a.zip@0"));
  EXPECT_THAT(refusal(std::string(100, 'x')), ErrorAt("a.zip@100"));
  EXPECT_THAT(refusal(ZipFixture{{{"a", "1"}, {"a", "2"}}}.bytes()), ErrorAt("a.zip@37", "a"));

  const std::string good = ZipFixture{{{"entry", "12345"}}}.bytes();
  const std::size_t record = good.find("PK\1\2");
  const auto patched = [&](std::size_t offset, std::uint64_t value, int count) {
    std::string bytes = good, field;
    test::append_little(field, value, count);
    return bytes.replace(record + offset, field.size(), field);
  };
  EXPECT_EQ(refusal(good), std::nullopt);
  EXPECT_THAT(refusal(patched(8, 1, 2)), ErrorAt("a.zip@45", "entry"));
  EXPECT_THAT(refusal(patched(10, 14, 2)), ErrorAt("a.zip@45", "entry", 14));
  EXPECT_THAT(refusal(patched(20, 6, 4)), ErrorAt("a.zip@45", "entry"));
  EXPECT_THAT(refusal(patched(20, 5000, 4)), ErrorAt("a.zip@45", "entry"));
  EXPECT_THAT(refusal(patched(42, 5000, 4)), ErrorAt("a.zip@45", "entry"));
  // The file states 3 GiB for five bytes, then 1 GiB, then a slightly wrong size.
  const std::string packed = ZipFixture{{{"entry", "12345", true}}}.bytes();
  const auto claimed = [&](std::uint64_t size) {
    std::string bytes = packed, field;
    test::append_little(field, size, 4);
    return bytes.replace(bytes.find("PK\1\2") + 24, 4, field);
  };
  EXPECT_EQ(refusal(claimed(5)), std::nullopt);
  EXPECT_THAT(refusal(claimed(3u << 30)), ErrorAt("a.zip@47", "2147483648"));
  EXPECT_THAT(refusal(claimed(1u << 30)), ErrorAt("a.zip@47", "entry"));
  EXPECT_THAT(refusal(claimed(6)), ErrorAt("a.zip@0", "entry"));
  // The directory states more entries than its bytes can contain.
  std::string many = good;
  many.replace(many.size() - 12, 2, "\xfe\xff");
  EXPECT_THAT(refusal(many), ErrorAt("a.zip@45", 65534));
}

TEST_P(Zip, SurvivesTruncationAndDamage) {
  const std::string bytes =
      ZipFixture{{{"a", "stored content"}, {"b", "deflated, deflated", true}}, GetParam()}.bytes();
  const auto read = [](std::span<const std::byte> damaged) {
    ZipArchive zip(Input::memory("a.zip", damaged));
    for (const ZipEntry& entry : zip.entries()) zip.read_all(entry, 1u << 20);
  };
  EXPECT_EQ(test::survive_truncation(as_bytes(bytes), read).read, 0u);
  EXPECT_GT(test::survive_damage(as_bytes(bytes), read).refused, 0u);
}

}  // namespace zip_archive_test
}  // namespace tureen
