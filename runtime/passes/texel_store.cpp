#include "runtime/passes/texel_store.hpp"

#include <algorithm>
#include <vector>

#include "base/error.hpp"
#include "runtime/gl/allocation.hpp"

namespace tureen {

TexelLayout TexelLayout::of(const DeviceLimits& limits) {
  TexelLayout layout;
  while ((1 << layout.row_bits) > limits.max_texture_size) --layout.row_bits;
  while ((1 << layout.layer_bits) > limits.max_texture_size) --layout.layer_bits;
  layout.max_layers = limits.max_array_layers;
  return layout;
}

TexelLayout TexelLayout::fitted(std::uint64_t max_texels) const {
  const std::uint64_t rows = (max_texels >> row_bits) + 1;
  TexelLayout layout = *this;
  if (rows <= std::uint64_t(1) << layer_bits) return layout;
  const auto largest = std::uint64_t(std::min(64, max_layers));
  while (layout.layer_bits > 0 && (rows >> (layout.layer_bits - 1)) < largest) --layout.layer_bits;
  return layout;
}

TexelStore::TexelStore(const TexelLayout& layout, const TexelSource& source) {
  const TexelFormat& format = source.format;
  const std::uint64_t count = source.count;
  const std::string& what = source.what;
  if (count > layout.capacity())
    throw DeviceLimitError(what + ": " + std::to_string(count) + " texels, but this device holds " +
                           std::to_string(layout.capacity()) + " in a texture of " +
                           std::to_string(layout.max_layers) + " layers; " +
                           std::to_string(layout.capacity() * 100 / count) +
                           "% of the scene fits, or a lower lattice level");
  const std::uint64_t columns = std::uint64_t(1) << layout.row_bits;
  const std::uint64_t rows_per_layer = std::uint64_t(1) << layout.layer_bits;
  const std::uint64_t rows = std::max<std::uint64_t>((count + columns - 1) / columns, 1);
  const std::uint64_t layers = (rows + rows_per_layer - 1) / rows_per_layer;
  const std::uint64_t height = std::min(rows, rows_per_layer);
  // A store shorter than a row is as wide as its contents.
  const std::uint64_t width = rows == 1 ? std::max<std::uint64_t>(count, 1) : columns;

  texture_ = gl::Texture::create();
  device_bytes_ = width * height * layers * format.bytes;
  glBindTexture(GL_TEXTURE_2D_ARRAY, texture_.id());
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAX_LEVEL, 0);
  if (gl::is_refused([&] {
        glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, static_cast<GLint>(format.internal_format),
                     static_cast<GLsizei>(width), static_cast<GLsizei>(height),
                     static_cast<GLsizei>(layers), 0, format.format, format.type, nullptr);
      }))
    throw DeviceLimitError(what + ": the device refuses a texture of " +
                           std::to_string(device_bytes_ >> 20) +
                           " MiB: use fewer triangles or a lower lattice level");

  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  // About 1 MiB at a time, so that the second copy stays small.
  const std::uint64_t rows_per_block =
      std::clamp<std::uint64_t>((std::uint64_t(1) << 20) / (width * format.bytes), 1, height);
  std::vector<std::byte> block(rows_per_block * width * format.bytes);
  for (std::uint64_t row = 0; row < rows;) {
    const std::uint64_t layer = row / rows_per_layer, row_in_layer = row % rows_per_layer;
    const std::uint64_t count_rows = std::min({rows_per_block, rows - row, height - row_in_layer});
    const std::uint64_t first = row * width;
    const std::uint64_t texels = std::min(count_rows * width, count - std::min(first, count));
    const std::span<std::byte> bytes(block.data(), texels * format.bytes);
    source.fill(first, bytes);
    std::fill(block.begin() + static_cast<std::ptrdiff_t>(bytes.size()), block.end(), std::byte{0});
    glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, static_cast<GLint>(row_in_layer),
                    static_cast<GLint>(layer), static_cast<GLsizei>(width),
                    static_cast<GLsizei>(count_rows), 1, format.format, format.type, block.data());
    row += count_rows;
  }
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
}

}  // namespace tureen
