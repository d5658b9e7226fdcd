#include "image/png.hpp"

#include <algorithm>
#include <climits>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <new>
#include <string_view>
#include <utility>

#include "base/stray_text.hpp"
#include "image/codecs/jpeg_tables.hpp"
#include "image/codecs/webp.hpp"
#include "image/decoder_memory.hpp"
#include "image/png_chunks.hpp"

#ifndef __EMSCRIPTEN__
#include <zlib.h>

namespace {

/// zlib replaces stb's compressor (figures: docs/decisions/png-by-stb.md), except in browser
/// builds, which have no zlib. stb releases the result with free().
unsigned char* compress_for_stb(unsigned char* data, int size, int* packed_size, int) {
  uLongf bound = compressBound(static_cast<uLong>(size));
  auto* packed = static_cast<unsigned char*>(std::malloc(bound));
  // Level 4 takes half the time of the default, 6, and about 3 % more bytes.
  if (!packed || compress2(packed, &bound, data, static_cast<uLong>(size), 4) != Z_OK ||
      bound > uLongf(INT_MAX)) {
    std::free(packed);
    return nullptr;
  }
  *packed_size = static_cast<int>(bound);
  return packed;
}

}  // namespace

#define STBIW_ZLIB_COMPRESS compress_for_stb
#endif

#define STBI_MALLOC(size) tureen::decoder_memory::allocate(size)
#define STBI_REALLOC(old, size) tureen::decoder_memory::reallocate(old, size)
#define STBI_FREE(old) tureen::decoder_memory::release(old)
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#define STBI_NO_HDR
#define STBI_NO_LINEAR
#include <stb/stb_image.h>
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>

namespace tureen {

namespace {

/// Memory for tables and for the decoder's state, in bytes. stb does not check this allocation.
constexpr std::uint64_t decoder_tables = std::uint64_t(1) << 20;

/// The maximum memory of stb for a valid image, in bytes. The file takes a buffer that doubles as
/// it grows. A pixel takes 8 bytes of inflated rows (16 bits per channel) or 12 of JPEG
/// coefficients, and 8 and 4 bytes before and after conversion. Sides are rounded up to JPEG
/// blocks, at most 32 pixels. Deflated data that need more are a decompression bomb.
std::uint64_t decoder_limit(std::size_t file, int width, int height) {
  const auto padded = [](int side) { return std::uint64_t(side) + 32; };
  return 4 * std::uint64_t(file) + 28 * padded(width) * padded(height) + decoder_tables;
}

std::string beyond(std::int64_t width, std::int64_t height) {
  return "an image of " + std::to_string(width) + " x " + std::to_string(height) +
         " pixels exceeds the limits: " + std::to_string(max_image_side) + " pixels per side and " +
         std::to_string(max_image_pixels) + " pixels in total";
}

/// stb's reason. For an unknown chunk stb returns its name, which may be any four bytes.
std::string reason_of_stb() {
  const std::string reason = stbi_failure_reason();
  return reason.size() > 4 ? reason : "it has an unknown chunk";
}

void refuse_damaged(std::span<const std::byte> bytes, const std::string& name) {
  if (const auto damage = png_damage(bytes))
    throw InputError({name, damage->byte, {}},
                     std::string("the image is damaged: ") + damage->reason);
}

/// The name of a kind of image that people have, and that needs another program; null for others.
const char* other_kind(std::span<const std::byte> bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()),
                              std::min<std::size_t>(bytes.size(), 16));
  if (text.starts_with("II*") || text.starts_with(std::string_view("MM\0*", 4))) return "TIFF";
  if (text.substr(std::min<std::size_t>(4, text.size())).starts_with("ftyp")) {
    const std::string_view brand = text.substr(8, 4);
    if (brand == "avif" || brand == "avis") return "AVIF";
    if (brand.starts_with("hei") || brand.starts_with("hev") || brand.starts_with("mif"))
      return "HEIC";
  }
  return nullptr;
}

void refuse_other_kind(std::span<const std::byte> bytes, const std::string& name) {
  if (const char* kind = other_kind(bytes))
    throw InputError({name}, "a " + std::string(kind) + " image is not supported",
                     "convert it, for example with: magick " + name + " " +
                         std::filesystem::path(name).replace_extension(".png").string());
}

/// The size of a PNG or JPEG by its header. Throws InputError if there is none, or beyond the
/// limits.
std::pair<int, int> stored_size(std::span<const std::byte> bytes, const std::string& name) {
  const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
  const int size = static_cast<int>(bytes.size());
  int width = 0, height = 0, channels = 0;
  const decoder_memory::Scope tables(MemoryBudget(decoder_tables), decoder_tables);
  if (!stbi_info_from_memory(data, size, &width, &height, &channels)) {
    // stb does not return the size of a PNG beyond its limits, so it is read from the header.
    const auto side = [&](std::size_t at) { return png_number(bytes.subspan(at)); };
    if (size >= 24 && is_png(bytes) &&
        (std::uint64_t(side(16)) * side(20) > max_image_pixels ||
         std::max(side(16), side(20)) > std::uint32_t(max_image_side)))
      throw InputError({name}, beyond(side(16), side(20)));
    refuse_damaged(bytes, name);
    if (const auto stray = stray_text(bytes.first(std::min<std::size_t>(bytes.size(), 512))))
      throw InputError({name}, stray->reason, stray->hint);
    throw InputError({name}, "not a PNG, JPEG or WebP image: " + reason_of_stb());
  }
  if (width < 1 || height < 1 || width > max_image_side || height > max_image_side ||
      std::size_t(width) * height > max_image_pixels)
    throw InputError({name}, beyond(width, height));
  return {width, height};
}

}  // namespace

glm::ivec2 image_size(std::span<const std::byte> bytes, const std::string& name) {
  if (bytes.size() > std::size_t(INT_MAX)) throw InputError({name}, "the image file exceeds 2 GiB");
  if (is_webp(bytes)) return webp_size(bytes, name);
  refuse_other_kind(bytes, name);
  const auto [width, height] = stored_size(bytes, name);
  return {width, height};
}

Image8 decode_image(std::span<const std::byte> bytes, const std::string& name,
                    MemoryBudget budget) {
  const auto fail = [&](const std::string& reason, const std::string& hint = {}) -> void {
    throw InputError({name}, reason, hint);
  };
  if (bytes.size() > std::size_t(INT_MAX)) fail("the image file exceeds 2 GiB");
  if (is_webp(bytes)) return decode_webp(bytes, name, std::move(budget));
  refuse_other_kind(bytes, name);
  if (const auto table = oversized_huffman_table(bytes)) {
    if (table->in_header)
      throw InputError({name, table->byte, {}},
                       "the image is damaged: a Huffman table has more than 256 codes");
    // The table is damage, or data after the image. The decoder gets only the bytes before it.
    bytes = bytes.first(static_cast<std::size_t>(table->byte));
  }
  auto [width, height] = stored_size(bytes, name);
  const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
  const int size = static_cast<int>(bytes.size());
  int channels = 0;
  refuse_damaged(bytes, name);
  PassingMemory passing(budget);
  const std::string what = "an image of " + std::to_string(width) + " x " + std::to_string(height);
  const std::uint64_t result_bytes = std::uint64_t(width) * std::uint64_t(height) * 4;
  if (!budget.take(result_bytes) || budget.left() < decoder_tables)
    fail(budget.refusal(what), max_memory_hint);
  const decoder_memory::Scope scope(budget, decoder_limit(bytes.size(), width, height));
  const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> pixels(
      stbi_load_from_memory(data, size, &width, &height, &channels, 4), &stbi_image_free);
  if (scope.beyond_budget()) fail(budget.refusal(what), max_memory_hint);
  if (scope.beyond_limit()) fail("the image is damaged: it decompresses to more than its pixels");
  if (!pixels) fail("the image is damaged: " + reason_of_stb());
  Image8 image(width, height);
  std::memcpy(image.pixels.data(), pixels.get(), image.pixels.size() * 4);
  passing.keep(result_bytes);
  return image;
}

Image8 read_image(Input& input) {
  PassingMemory passing(input.budget());
  Image8 image = decode_image(input.read_rest(), input.name(), input.budget());
  passing.keep(image.pixels.size() * sizeof image.pixels[0]);
  return image;
}

std::vector<std::byte> encode_png(const Image8& image) {
  int size = 0;
  const std::unique_ptr<unsigned char, decltype(&std::free)> encoded(
      stbi_write_png_to_mem(reinterpret_cast<const unsigned char*>(image.pixels.data()),
                            image.width * 4, image.width, image.height, 4, &size),
      &std::free);
  if (!encoded) throw std::bad_alloc();
  const auto* begin = reinterpret_cast<const std::byte*>(encoded.get());
  return {begin, begin + size};
}

}  // namespace tureen
