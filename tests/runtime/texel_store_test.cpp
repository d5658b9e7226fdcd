// Texel stores that are filled piece by piece.
#include "runtime/passes/texel_store.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "runtime/gl/api.hpp"
#include "tests/support/contexts.hpp"

namespace tureen {
namespace texel_store_test {

std::vector<std::uint32_t> numbers(std::size_t count) {
  std::vector<std::uint32_t> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = std::uint32_t(i + 1);
  return values;
}

/// The first texels of a store of numbers.
std::vector<std::uint32_t> contents(const TexelStore& store, std::size_t count) {
  std::vector<std::uint32_t> values(256, 0);
  glBindTexture(GL_TEXTURE_2D_ARRAY, store.texture());
  glGetTexImage(GL_TEXTURE_2D_ARRAY, 0, GL_RED_INTEGER, GL_UNSIGNED_INT, values.data());
  values.resize(count);
  return values;
}

/// Layers with few rows, so that pieces reach over their ends.
TEST(TexelUpload, FillsTheStoreInAnyPieces) {
  const gl::Context context = gl::Context::create(test::osmesa);
  const TexelLayout layout{.row_bits = 3, .layer_bits = 2, .max_layers = 8};
  for (const std::size_t count : {1u, 5u, 8u, 9u, 32u, 40u, 61u, 96u}) {
    const std::vector<std::uint32_t> values = numbers(count);
    const TexelSource source = TexelSource::of(texel_formats::r32ui, values, "numbers");
    const std::size_t row = std::min<std::size_t>(count, 8);
    for (const std::size_t rows : {1u, 3u, 100u}) {
      TexelUpload upload(layout, source);
      for (std::size_t first = 0; first < count; first += rows * row)
        upload.put(first, std::as_bytes(std::span(values).subspan(
                              first, std::min(rows * row, count - first))));
      EXPECT_EQ(contents(std::move(upload).finish(), count), values)
          << count << " texels, " << rows << " rows a piece";
    }
    EXPECT_EQ(contents(TexelStore(layout, source), count), values);
  }
}

TEST(TexelUpload, IsTakenByTheStoreOfItsSource) {
  const gl::Context context = gl::Context::create(test::osmesa);
  const TexelLayout layout;
  const std::vector<std::uint32_t> values = numbers(5);
  TexelSource source{texel_formats::r32ui, values.size(), "numbers", nullptr, nullptr};
  TexelUpload upload(layout, source);
  upload.put(0, std::as_bytes(std::span(values)));
  source.store = std::make_shared<TexelStore>(std::move(upload).finish());
  const TexelStore store(layout, source);
  EXPECT_EQ(contents(store, 5), values);
  EXPECT_EQ(store.device_bytes(), 20u);
}

}  // namespace texel_store_test
}  // namespace tureen
