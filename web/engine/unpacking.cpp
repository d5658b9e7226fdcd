#include "web/engine/unpacking.hpp"

#include <utility>

namespace tureen::web {

void take_head(Engine& engine) {
  engine.arriving.reset();
  engine.arriving.emplace(std::exchange(engine.buffer, {}), engine.read_blob);
}

void upload_block(Engine& engine, const Json& arguments) {
  engine.arriving.value().upload(arguments.at("blob"), arguments.at("offset"), engine.buffer);
}

PreparedScene unpacked(Engine& engine) {
  ArrivingScene scene = std::move(engine.arriving.value());
  engine.arriving.reset();
  return std::move(scene).take();
}

}  // namespace tureen::web
