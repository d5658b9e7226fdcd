#include "image/codecs/webp.hpp"

#ifndef __EMSCRIPTEN__
#include <webp/decode.h>
#include <webp/encode.h>
#endif

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <new>
#include <string_view>

#include "base/error.hpp"
#include "image/png.hpp"

namespace tureen {

namespace {

bool has_text(std::span<const std::byte> bytes, std::size_t at, std::string_view text) {
  return bytes.size() >= at + text.size() &&
         std::equal(text.begin(), text.end(), bytes.begin() + std::ptrdiff_t(at),
                    [](char c, std::byte b) { return std::byte(c) == b; });
}

}  // namespace

bool is_webp(std::span<const std::byte> bytes) {
  return has_text(bytes, 0, "RIFF") && has_text(bytes, 8, "WEBP");
}

#ifdef __EMSCRIPTEN__
glm::ivec2 webp_size(std::span<const std::byte>, const std::string& name) {
  throw InputError({name}, "WebP images are not supported here");
}
Image8 decode_webp(std::span<const std::byte> bytes, const std::string& name, MemoryBudget) {
  const glm::ivec2 size = webp_size(bytes, name);  // throws
  return {size.x, size.y};
}
#else
glm::ivec2 webp_size(std::span<const std::byte> bytes, const std::string& name) {
  WebPBitstreamFeatures features;
  if (WebPGetFeatures(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(),
                      &features) != VP8_STATUS_OK)
    throw InputError({name}, "the WebP image is damaged");
  if (features.has_animation)
    throw InputError({name}, "the WebP file is an animation, not an image");
  return {features.width, features.height};
}

Image8 decode_webp(std::span<const std::byte> bytes, const std::string& name, MemoryBudget budget) {
  const auto fail = [&](const std::string& reason, const std::string& hint = {}) -> void {
    throw InputError({name}, reason, hint);
  };
  const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  const glm::ivec2 sides = webp_size(bytes, name);
  const std::string what =
      "an image of " + std::to_string(sides.x) + " x " + std::to_string(sides.y);
  // The result, and as much for the decoder.
  const std::uint64_t size = std::uint64_t(sides.x) * std::uint64_t(sides.y) * 4;
  PassingMemory passing(budget);
  if (!budget.take(size, 2)) fail(budget.refusal(what), max_memory_hint);
  Image8 image(sides.x, sides.y);
  if (!WebPDecodeRGBAInto(data, bytes.size(), reinterpret_cast<std::uint8_t*>(image.pixels.data()),
                          size, sides.x * 4))
    fail("the WebP image is damaged");
  passing.keep(size);
  return image;
}

std::vector<std::byte> encode_webp(const Image8& image, int effort) {
  WebPConfig config;
  WebPPicture picture;
  std::vector<std::byte> bytes;
  bool done = WebPConfigInit(&config) && WebPConfigLosslessPreset(&config, effort) &&
              WebPPictureInit(&picture);
  assert(done);  // the effort, and the version of the library
  config.exact = 1;
  picture.use_argb = 1;
  picture.width = image.width;
  picture.height = image.height;
  picture.custom_ptr = &bytes;
  picture.writer = [](const std::uint8_t* data, std::size_t size, const WebPPicture* target) {
    auto& out = *static_cast<std::vector<std::byte>*>(target->custom_ptr);
    const auto* begin = reinterpret_cast<const std::byte*>(data);
    try {  // the caller is C
      out.insert(out.end(), begin, begin + size);
    } catch (const std::bad_alloc&) {
      return 0;
    }
    return 1;
  };
  done = WebPPictureImportRGBA(&picture, reinterpret_cast<const std::uint8_t*>(image.pixels.data()),
                               4 * image.width) &&
         WebPEncode(&config, &picture);
  WebPPictureFree(&picture);
  if (!done) throw std::bad_alloc();  // the size is the caller's, so it is the only fault left
  return bytes;
}
#endif

}  // namespace tureen
