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

PreparedScene unpacked() {
  static const BlobReader read = pull_block;  // the sources refer to it
  return unpack(std::exchange(taken_head(), {}), read);
}

}  // namespace tureen::web
