// A prepared soup on its way from the instance that reads scenes (in a worker, and gone with it) to
// the one that draws them: a head, and blobs that are handed over block by block, so that neither
// instance ever holds the bytes of the device twice.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "runtime/prepared_soup.hpp"

namespace tureen::web {

/// Everything but the blobs.
std::vector<std::byte> pack_head(const PreparedSoup& prepared);

/// Blob 0 is the corners of the faces, the others are the appearance's stores.
std::size_t blob_count(const PreparedSoup& prepared);
std::uint64_t blob_size(const PreparedSoup& prepared, std::size_t blob);

/// Writes the bytes of a blob from `offset` on. Offset and size must be multiples of blob_grain()
/// or end with the blob.
void read_blob(const PreparedSoup& prepared, std::size_t blob, std::uint64_t offset,
               std::span<std::byte> out);
std::size_t blob_grain(const PreparedSoup& prepared, std::size_t blob);

using BlobReader =
    std::function<void(std::size_t blob, std::uint64_t offset, std::span<std::byte> out)>;

/// Its sources read through `read`, which must live as long as they.
PreparedSoup unpack(std::span<const std::byte> head, const BlobReader& read);

}  // namespace tureen::web
