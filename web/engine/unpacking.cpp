#include "web/engine/unpacking.hpp"

#include <utility>

#include "web/engine/prepared_archive.hpp"

namespace tureen::web {

namespace {

std::vector<std::byte>& taken_head() {
  static std::vector<std::byte> head;
  return head;
}

}  // namespace

Json take_head(const Json&) {
  taken_head() = std::exchange(buffer(), {});
  return nullptr;
}

Renderer unpacked(const gl::Context& context) {
  return Renderer(context, unpack(std::exchange(taken_head(), {}), pull_block));
}

}  // namespace tureen::web
