#include "web/engine/unpacking.hpp"

#include <utility>

#include "web/engine/prepared_archive.hpp"

namespace tureen::web {

namespace {

Heads& heads() {
  static Heads both;
  return both;
}

}  // namespace

Json take_head(const Json& arguments) {
  (arguments.at("preset").get<bool>() ? heads().quick : heads().faithful) = std::move(buffer());
  buffer() = {};
  return nullptr;
}

Heads taken_heads() { return std::exchange(heads(), {}); }

Renderer unpacked(const gl::Context& context, const std::vector<std::byte>& head,
                  std::size_t first_blob) {
  const BlobReader read = [first_blob](std::size_t blob, std::uint64_t offset,
                                       std::span<std::byte> out) {
    pull_block(first_blob + blob, offset, out);
  };
  return Renderer(context, unpack(head, read));
}

}  // namespace tureen::web
