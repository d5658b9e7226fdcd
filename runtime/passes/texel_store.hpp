// A linear array of texels on the device, of any length that a scene needs: rows in the layers of a
// 2D array texture. shaders/texel_store.glsl locates a texel by its index.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "runtime/gl/objects.hpp"
#include "runtime/plan/plan.hpp"

namespace tureen {

/// The split of the index into column, row and layer, equal for all stores of a scene. Every device
/// supports at least 256 layers. With layers of 2^21 texels, they hold 2^29 texels.
struct TexelLayout {
  int row_bits = 12;   // 4096 columns; 2048 on devices with that limit; at least 2
  int layer_bits = 9;  // 512 rows a layer
  int max_layers = 256;

  static TexelLayout of(const DeviceLimits& limits);
  /// The layout for stores of at most `max_texels` texels. If they fill less than one layer, the
  /// layout is unchanged. Otherwise layers get fewer rows, so that the largest store has at least
  /// 32 layers, if the device allows it. Its last layer then wastes at most 1/32 of the store.
  TexelLayout fitted(std::uint64_t max_texels) const;
  std::uint64_t row_texels() const { return std::uint64_t(1) << row_bits; }
  std::uint64_t texels_per_layer() const { return std::uint64_t(1) << (row_bits + layer_bits); }
  /// Largest number of texels in one store: shaders count them in 32 bits.
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

class TexelStore;

/// The contents of a store before a device exists.
struct TexelSource {
  TexelFormat format = texel_formats::rgba8;
  std::uint64_t count = 0;
  std::string what;  // name of the contents, for messages
  /// Writes out.size() / format.bytes texels from `first` on. `first` increases from call to call,
  /// so the complete contents never need to be in memory twice.
  std::function<void(std::uint64_t first, std::span<std::byte> out)> fill;
  /// If it is set, the texels are on the device already (TexelUpload), and the first TexelStore of
  /// this source takes it.
  std::shared_ptr<TexelStore> store = {};

  /// A source that owns its values. Each texel takes format.bytes bytes of them.
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
  /// Throws DeviceLimitError if the texels exceed the layout's capacity (the reason has the
  /// fraction that fits) or the device's memory.
  TexelStore(const TexelLayout& layout, const TexelSource& source);

  GLuint texture() const { return texture_.id(); }
  std::size_t device_bytes() const { return device_bytes_; }

 private:
  friend class TexelUpload;
  gl::Texture texture_;
  std::size_t device_bytes_ = 0;
};

/// Fills a store piece by piece, for texels that arrive while the device draws other things.
class TexelUpload {
 public:
  /// Throws as TexelStore does. The source's texels are not read.
  TexelUpload(const TexelLayout& layout, const TexelSource& source);

  /// Uploads texels from `first` on, a multiple of the layout's row. `bytes` are whole rows, or end
  /// with the last texel. The pixel-transfer parameters must have their initial values.
  void put(std::uint64_t first, std::span<const std::byte> bytes);
  /// After all texels.
  TexelStore finish() && { return std::move(store_); }

 private:
  friend class TexelStore;
  std::size_t row_bytes() const { return std::size_t(width_) * format_.bytes; }

  TexelFormat format_;
  std::uint64_t width_ = 1, height_ = 1;  // of a layer, in texels
  TexelStore store_;
  std::vector<std::byte> last_row_;  // padded
};

}  // namespace tureen
