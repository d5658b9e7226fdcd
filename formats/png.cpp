#include "formats/png.hpp"

#include <climits>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>

#ifndef __EMSCRIPTEN__
#include <zlib.h>

namespace {

/// zlib instead of stb's own compressor: docs/decisions/png-by-stb.md has the figures. Only a
/// browser build, which has no zlib, does without. The memory is stb's to free().
unsigned char* compress_for_stb(unsigned char* data, int size, int* packed_size, int) {
  uLongf bound = compressBound(static_cast<uLong>(size));
  auto* packed = static_cast<unsigned char*>(std::malloc(bound));
  // Level 4 takes half of the time of the default 6 and some 3 % more bytes.
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

Image8 decode_image(std::span<const std::byte> bytes, const std::string& name) {
  const auto fail = [&](const std::string& reason) -> void {
    throw InputError({name, {}, {}}, reason);
  };
  if (bytes.size() > std::size_t(INT_MAX)) fail("an image of over 2 GiB");
  const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
  const int size = static_cast<int>(bytes.size());
  int width = 0, height = 0, channels = 0;
  if (!stbi_info_from_memory(data, size, &width, &height, &channels))
    fail(std::string("not a PNG or JPEG image: ") + stbi_failure_reason());
  if (width < 1 || height < 1 || width > max_image_side || height > max_image_side ||
      std::size_t(width) * height > max_image_pixels)
    fail("an image of " + std::to_string(width) + " x " + std::to_string(height) +
         " pixels is beyond what we read");
  const std::unique_ptr<stbi_uc, decltype(&std::free)> pixels(
      stbi_load_from_memory(data, size, &width, &height, &channels, 4), &std::free);
  if (!pixels) fail(std::string("the image is damaged: ") + stbi_failure_reason());
  Image8 image(width, height);
  std::memcpy(image.pixels.data(), pixels.get(), image.pixels.size() * 4);
  return image;
}

Image8 read_image(Input& input) { return decode_image(input.read_rest(), input.name()); }

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
