// A packed scene whose texels are uploaded block by block, while its other blocks still arrive.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "web/engine/prepared_archive.hpp"

namespace tureen::web {

class ArrivingScene {
 public:
  /// `read` must outlive the scene.
  ArrivingScene(std::span<const std::byte> head, const BlobReader& read);

  /// Uploads bytes of a store, from `offset` on, a multiple of blob_grain(). All blocks of a blob
  /// come in order, before those of another blob. The context must be current. Throws
  /// DeviceLimitError.
  void upload(std::size_t blob, std::uint64_t offset, std::span<const std::byte> bytes);

  /// The scene. It reads all blobs that were not uploaded.
  PreparedScene take() &&;

 private:
  void finish_upload();

  const BlobReader& read_;
  PreparedScene scene_;
  std::size_t blob_ = 0;               // that is being uploaded
  std::optional<TexelUpload> upload_;  // of its store
};

}  // namespace tureen::web
