// Huffman tables that would overflow stb's table: they are found wherever a decoder could find
// them, and nowhere else.
#include "image/codecs/jpeg_tables.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "image/png.hpp"
#include "tests/fuzz/fixtures.hpp"
#include "tests/support/errors.hpp"

namespace tureen {
namespace jpeg_tables_test {

using test::error_of;
using test::ErrorAt;
using ::testing::Eq;
using Bytes = std::vector<unsigned>;

std::vector<std::byte> bytes_of(const Bytes& values) {
  std::vector<std::byte> bytes;
  for (const unsigned value : values) bytes.push_back(static_cast<std::byte>(value));
  return bytes;
}

std::optional<std::uint64_t> found(const Bytes& values) {
  const auto table = oversized_huffman_table(bytes_of(values));
  return table ? std::optional(table->byte) : std::nullopt;
}

Bytes operator+(Bytes a, const Bytes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// A table of `codes` codes of 16 bits; the first 255 have 15 bits.
Bytes table(unsigned codes) {
  const unsigned longest = codes > 255 ? codes - 255 : 0;
  Bytes bytes{0xff, 0xc4, (19 + codes) >> 8, (19 + codes) & 255, 0x10};
  for (int i = 1; i <= 14; ++i) bytes.push_back(0);
  bytes.push_back(codes - longest);
  bytes.push_back(longest);
  return bytes + Bytes(codes, 7);
}

const Bytes soi{0xff, 0xd8}, scan{0xff, 0xda, 0, 8, 1, 1, 0, 0, 63, 0, 0x5a};

TEST(JpegTables, OfMoreThan256CodesAreFoundWhereTheyStand) {
  EXPECT_THAT(found(soi + table(256) + scan), Eq(std::nullopt));
  EXPECT_THAT(found(soi + table(257) + scan), Eq(2u));
  EXPECT_THAT(found(soi + table(12) + table(300) + scan), Eq(2u + 21 + 12));
  EXPECT_THAT(found(Bytes{0xff, 0xff} + soi + table(257)), Eq(4u));
  EXPECT_THAT(found(soi + Bytes{1, 2, 0xff} + table(257)), Eq(5u)) << "after other bytes";
  EXPECT_THAT(found(soi + scan + Bytes{0x11, 0xff, 0} + table(257)), Eq(2u + scan.size() + 3))
      << "after a scan";
  EXPECT_THAT(found(table(257)), Eq(std::nullopt)) << "not a JPEG";
  EXPECT_THAT(found({}), Eq(std::nullopt));
  EXPECT_THAT(found(soi), Eq(std::nullopt));
}

TEST(JpegTables, AreNotFoundInWhatDecodersPassOver) {
  // The thumbnail of a photograph, and a quantisation table that looks like application data.
  const Bytes hidden = table(257);
  const auto size = unsigned(hidden.size() + 2);
  EXPECT_THAT(found(soi + Bytes{0xff, 0xe1, size >> 8, size & 255} + hidden + scan),
              Eq(std::nullopt));
  Bytes quantisation{0xff, 0xdb, 0, 67, 0};
  for (int i = 0; i < 16; ++i) quantisation = quantisation + Bytes{0xff, 0xe1, 0x7f, 0xff};
  EXPECT_THAT(found(soi + quantisation + table(257)), Eq(2u + 69));
}

TEST(JpegTables, AreRefusedBeforeAnythingIsDecoded) {
  EXPECT_THAT(error_of([&] { decode_image(bytes_of(soi + table(400) + scan), "a.jpg"); }),
              ErrorAt("a.jpg@2", 256));
  for (const fuzz::Fixture& fixture : fuzz::fixtures())
    EXPECT_FALSE(oversized_huffman_table(fixture.bytes)) << fixture.name;
}

TEST(JpegTables, BehindAnImageAreNoneOfIt) {
  int images = 0;
  for (const fuzz::Fixture& fixture : fuzz::fixtures()) {
    if (fixture.target != "image" || fixture.bytes.at(0) != std::byte(0xff)) continue;
    ++images;
    // As from a telephone that appends a video.
    std::vector<std::byte> with_video = fixture.bytes;
    const auto video = bytes_of(table(257) + Bytes(100, 0x5a));
    with_video.insert(with_video.end(), video.begin(), video.end());
    EXPECT_EQ(decode_image(with_video, "video.jpg").pixels,
              decode_image(fixture.bytes, "still.jpg").pixels)
        << fixture.name;
  }
  EXPECT_GT(images, 0);
}

}  // namespace jpeg_tables_test
}  // namespace tureen
