// A linear array of texels on the device, as long as a scene needs: rows in the layers of a 2D
// array texture. shaders/texel_store.glsl finds a texel by its index.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "runtime/gl/objects.hpp"
#include "runtime/plan/plan.hpp"

namespace tureen {

/// How the index is cut into column, row and layer. The same for every store of a scene. Layers of
/// 2^21 texels let 256 of them, the least that any device has, hold 2^29 texels.
struct TexelLayout {
  int row_bits = 12;   // 4096 columns, 2048 on devices that have no more
  int layer_bits = 9;  // rows of a layer
  int max_layers = 256;

  static TexelLayout of(const DeviceLimits& limits);
  /// For a store of so many texels that does not fit into one layer, which is as high as its
  /// contents: with layers so low that it has 32 to 64 of them and the last one wastes at most a
  /// thirty-second.
  TexelLayout fitted(std::uint64_t most_texels) const;
  std::uint64_t texels_per_layer() const { return std::uint64_t(1) << (row_bits + layer_bits); }
  /// The most texels that one store can hold: shaders count them in 32 bits.
  std::uint64_t capacity() const {
    return std::min(texels_per_layer() * std::uint64_t(max_layers), std::uint64_t(1) << 32);
  }
};

struct TexelFormat {
  GLenum internal_format, format, type;
  std::size_t bytes;  // of a texel
};

namespace texel_formats {
inline constexpr TexelFormat r8{GL_R8, GL_RED, GL_UNSIGNED_BYTE, 1};
inline constexpr TexelFormat rgba8{GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, 4};
inline constexpr TexelFormat r32f{GL_R32F, GL_RED, GL_FLOAT, 4};
inline constexpr TexelFormat rg32f{GL_RG32F, GL_RG, GL_FLOAT, 8};
inline constexpr TexelFormat rgb32f{GL_RGB32F, GL_RGB, GL_FLOAT, 12};
inline constexpr TexelFormat rgba32f{GL_RGBA32F, GL_RGBA, GL_FLOAT, 16};
inline constexpr TexelFormat r32ui{GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, 4};
inline constexpr TexelFormat rg32ui{GL_RG32UI, GL_RG_INTEGER, GL_UNSIGNED_INT, 8};
inline constexpr TexelFormat rgba32ui{GL_RGBA32UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT, 16};
}  // namespace texel_formats

/// What a store will hold, before there is a device for it.
struct TexelSource {
  TexelFormat format = texel_formats::rgba8;
  std::uint64_t count = 0;
  std::string what;  // names the contents, for people
  /// Writes the texels from `first` on, out.size() / format.bytes of them; called with growing
  /// `first`, so that contents larger than memory can hold twice need never be whole.
  std::function<void(std::uint64_t first, std::span<std::byte> out)> fill;

  /// Of values that the source keeps: format.bytes of them are a texel.
  template <class T>
  static TexelSource of(const TexelFormat& format, std::vector<T> values, std::string what) {
    const std::uint64_t count = values.size() * sizeof(T) / format.bytes;
    return {format, count, std::move(what),
            [values = std::move(values), each = format.bytes](std::uint64_t first,
                                                              std::span<std::byte> out) {
              std::copy_n(std::as_bytes(std::span(values)).data() + first * each, out.size(),
                          out.data());
            }};
  }
};

class TexelStore {
 public:
  TexelStore() = default;
  /// Throws DeviceLimitError with what would fit.
  TexelStore(const TexelLayout& layout, const TexelSource& source);

  GLuint texture() const { return texture_.id(); }
  std::size_t device_bytes() const { return device_bytes_; }

 private:
  gl::Texture texture_;
  std::size_t device_bytes_ = 0;
};

}  // namespace tureen
