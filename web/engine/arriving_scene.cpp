#include "web/engine/arriving_scene.hpp"

#include <memory>
#include <utility>

#include "runtime/gl/state.hpp"

namespace tureen::web {

ArrivingScene::ArrivingScene(std::span<const std::byte> head, const BlobReader& read)
    : read_(read), scene_(unpack(head, read)) {}

void ArrivingScene::upload(std::size_t blob, std::uint64_t offset,
                           std::span<const std::byte> bytes) {
  const auto [source, layout] = store_of(scene_, blob);
  gl::use_plain_pixel_transfer();
  if (!upload_ || blob_ != blob) {
    finish_upload();
    blob_ = blob;
    upload_.emplace(layout, *source);
  }
  upload_->put(offset / source->format.bytes, bytes);
}

void ArrivingScene::finish_upload() {
  if (!upload_) return;
  TexelStore store = std::move(*upload_).finish();
  store_of(scene_, blob_).source->store = std::make_shared<TexelStore>(std::move(store));
  upload_.reset();
}

PreparedScene ArrivingScene::take() && {
  finish_upload();
  read_rows(scene_, read_);
  return std::move(scene_);
}

}  // namespace tureen::web
