// Transfers a prepared scene from the instance that reads scenes (in a worker, which then ends) to
// the instance that draws them: a head, and blobs. The blobs are transferred block by block, so
// neither instance holds the device's bytes twice.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "runtime/prepared_scene.hpp"

namespace tureen::web {

/// Everything except the blobs and make_passes, which the drawing instance has.
std::vector<std::byte> pack_head(const PreparedScene& prepared);

/// The blobs of each layer in turn: the corners of its faces, then its appearance's stores; for
/// splats, the stores of kernel and coefficients, or the rows for TilePass.
std::size_t blob_count(const PreparedScene& prepared);
std::uint64_t blob_size(const PreparedScene& prepared, std::size_t blob);

/// Copies the bytes of a blob from `offset` on. Offset and size must be multiples of blob_grain(),
/// except at the blob's end.
void read_blob(const PreparedScene& prepared, std::size_t blob, std::uint64_t offset,
               std::span<std::byte> out);
/// Of a store: a row on the device.
std::size_t blob_grain(const PreparedScene& prepared, std::size_t blob);

using BlobReader =
    std::function<void(std::size_t blob, std::uint64_t offset, std::span<std::byte> out)>;

/// The sources of the result use `read`, which must outlive them. Call read_rows() before drawing.
PreparedScene unpack(std::span<const std::byte> head, const BlobReader& read);
/// Reads the rows for TilePass.
void read_rows(PreparedScene& prepared, const BlobReader& read);

/// The store with the texels of a blob, and its layout; null for other blobs.
struct BlobStore {
  TexelSource* source = nullptr;
  TexelLayout layout = {};
};
BlobStore store_of(PreparedScene& prepared, std::size_t blob);

}  // namespace tureen::web
