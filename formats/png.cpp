#include "formats/png.hpp"

#include <climits>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <new>

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
