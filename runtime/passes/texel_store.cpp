#include "runtime/passes/texel_store.hpp"

#include <cassert>

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

TexelUpload::TexelUpload(const TexelLayout& layout, const TexelSource& source)
    : format_(source.format) {
  const std::uint64_t count = source.count;
  const std::string& what = source.what;
  if (count > layout.capacity())
    throw DeviceLimitError(what + ": " + std::to_string(count) + " texels, but this device holds " +
                           std::to_string(layout.capacity()) + " in a texture of " +
                           std::to_string(layout.max_layers) + " layers; " +
                           std::to_string(layout.capacity() * 100 / count) +
                           "% of the scene fits, or a lower lattice level");
  const std::uint64_t rows_per_layer = std::uint64_t(1) << layout.layer_bits;
  width_ = layout.row_texels();
  const std::uint64_t rows = std::max<std::uint64_t>((count + width_ - 1) / width_, 1);
  const std::uint64_t layers = (rows + rows_per_layer - 1) / rows_per_layer;
  height_ = std::min(rows, rows_per_layer);
  // A store shorter than a row is as wide as its contents.
  if (rows == 1) width_ = std::max<std::uint64_t>(count, 1);

  store_.texture_ = gl::Texture::create();
  store_.device_bytes_ = row_bytes() * height_ * layers;
  glBindTexture(GL_TEXTURE_2D_ARRAY, store_.texture());
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAX_LEVEL, 0);
  if (gl::is_refused([&] {
        glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, static_cast<GLint>(format_.internal_format),
                     static_cast<GLsizei>(width_), static_cast<GLsizei>(height_),
                     static_cast<GLsizei>(layers), 0, format_.format, format_.type, nullptr);
      }))
    throw DeviceLimitError(what + ": the device refuses a texture of " +
                           std::to_string(store_.device_bytes_ >> 20) +
                           " MiB: use fewer triangles or a lower lattice level");
}

void TexelUpload::put(std::uint64_t first, std::span<const std::byte> bytes) {
  // The initial alignment of 4 bytes fits: where a store has several rows, each has at least 4
  // texels, in a power of two.
  glBindTexture(GL_TEXTURE_2D_ARRAY, store_.texture());
  const auto upload = [&](std::uint64_t row, std::uint64_t rows, const std::byte* data) {
    glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, static_cast<GLint>(row % height_),
                    static_cast<GLint>(row / height_), static_cast<GLsizei>(width_),
                    static_cast<GLsizei>(rows), 1, format_.format, format_.type, data);
  };
  std::uint64_t row = first / width_;
  while (bytes.size() >= row_bytes()) {
    const std::uint64_t rows =
        std::min<std::uint64_t>(bytes.size() / row_bytes(), height_ - row % height_);
    upload(row, rows, bytes.data());
    bytes = bytes.subspan(static_cast<std::size_t>(rows) * row_bytes());
    row += rows;
  }
  if (!bytes.empty()) {
    last_row_.assign(row_bytes(), std::byte{0});
    std::copy(bytes.begin(), bytes.end(), last_row_.begin());
    upload(row, 1, last_row_.data());
  }
}

TexelStore::TexelStore(const TexelLayout& layout, const TexelSource& source) {
  if (source.store) {
    assert(source.store->texture() != 0);  // taken once
    *this = std::move(*source.store);
    return;
  }
  TexelUpload upload(layout, source);
  // About 1 MiB at a time, so that the second copy stays small.
  const std::uint64_t block_texels =
      std::max<std::uint64_t>((std::uint64_t(1) << 20) / upload.row_bytes(), 1) * upload.width_;
  std::vector<std::byte> block;
  for (std::uint64_t first = 0; first < source.count; first += block_texels) {
    block.resize(std::size_t(std::min(block_texels, source.count - first)) * source.format.bytes);
    source.fill(first, block);
    upload.put(first, block);
  }
  *this = std::move(upload).finish();
}

}  // namespace tureen
