#include "web/engine/unpacking.hpp"

#include <optional>
#include <utility>

#include "web/engine/arriving_scene.hpp"

namespace tureen::web {

namespace {

std::optional<ArrivingScene>& arriving() {
  static std::optional<ArrivingScene> one;
  return one;
}

}  // namespace

void take_head(const Json&) {
  static const BlobReader read = pull_block;  // the scene refers to it
  arriving().reset();
  arriving().emplace(std::exchange(buffer(), {}), read);
}

void upload_block(const Json& arguments) {
  arriving().value().upload(arguments.at("blob"), arguments.at("offset"), buffer());
}

void forget_head() { arriving().reset(); }

PreparedScene unpacked() {
  ArrivingScene scene = std::move(arriving().value());
  arriving().reset();
  return std::move(scene).take();
}

}  // namespace tureen::web
