// Foreign GLB files for tests.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "image/png.hpp"

namespace tureen::test {

/// Builds a GLB; each accessor is appended when it is needed.
class GlbBuilder {
 public:
  nlohmann::json document = {
      {"asset", {{"version", "2.0"}}},
      {"scene", 0},
      {"scenes", nlohmann::json::array({{{"nodes", nlohmann::json::array({0})}}})},
      {"nodes", nlohmann::json::array({{{"mesh", 0}}})},
      {"meshes", nlohmann::json::array({{{"primitives", nlohmann::json::array()}}})},
      {"accessors", nlohmann::json::array()},
      {"bufferViews", nlohmann::json::array()}};

  int view(const void* data, std::size_t size) {
    document["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", size}});
    const std::size_t at = bytes_.size();
    bytes_.resize(at + (size + 3) / 4 * 4);
    std::memcpy(bytes_.data() + at, data, size);
    return int(document["bufferViews"].size()) - 1;
  }

  template <class T>
  int accessor(const std::vector<T>& values, const char* type, int component, std::size_t count,
               bool normalized = false) {
    nlohmann::json a = {{"bufferView", view(values.data(), values.size() * sizeof(T))},
                        {"componentType", component},
                        {"count", count},
                        {"type", type}};
    if (normalized) a["normalized"] = true;
    return add_accessor(a);
  }
  int add_accessor(nlohmann::json a) {
    document["accessors"].push_back(std::move(a));
    return int(document["accessors"].size()) - 1;
  }
  int floats(const std::vector<float>& values, int components) {
    static const char* types[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
    return accessor(values, types[components - 1], 5126, values.size() / std::size_t(components));
  }

  nlohmann::json& primitive(nlohmann::json attributes) {
    auto& list = document["meshes"][0]["primitives"];
    list.push_back({{"attributes", std::move(attributes)}});
    return list.back();
  }
  /// One triangle at (0,0,0) (1,0,0) (0,1,0).
  nlohmann::json& triangle() {
    return primitive({{"POSITION", floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, 3)}});
  }

  int texture(const Image8& image, const nlohmann::json& sampler = {}) {
    const auto png = encode_png(image);
    document["images"].push_back(
        {{"bufferView", view(png.data(), png.size())}, {"mimeType", "image/png"}});
    nlohmann::json t = {{"source", document["images"].size() - 1}};
    if (!sampler.is_null()) {
      document["samplers"].push_back(sampler);
      t["sampler"] = document["samplers"].size() - 1;
    }
    document["textures"].push_back(t);
    return int(document["textures"].size()) - 1;
  }
  int material(nlohmann::json m) {
    document["materials"].push_back(std::move(m));
    return int(document["materials"].size()) - 1;
  }

  std::vector<std::byte> glb() const {
    nlohmann::json complete = document;
    if (!bytes_.empty())
      complete["buffers"] = nlohmann::json::array({{{"byteLength", bytes_.size()}}});
    std::string text = complete.dump();
    text.append((4 - text.size() % 4) % 4, ' ');
    std::vector<std::uint32_t> head = {0x46546C67, 2, 0, std::uint32_t(text.size()), 0x4E4F534A};
    const std::size_t bin = bytes_.empty() ? 0 : 8 + bytes_.size();
    head[2] = std::uint32_t(20 + text.size() + bin);
    std::vector<std::byte> result(head[2]);
    std::memcpy(result.data(), head.data(), 20);
    std::memcpy(result.data() + 20, text.data(), text.size());
    if (bin > 0) {
      const std::uint32_t chunk[2] = {std::uint32_t(bytes_.size()), 0x004E4942};
      std::memcpy(result.data() + 20 + text.size(), chunk, 8);
      std::memcpy(result.data() + 28 + text.size(), bytes_.data(), bytes_.size());
    }
    return result;
  }
  const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  std::vector<std::byte> bytes_;
};

}  // namespace tureen::test
