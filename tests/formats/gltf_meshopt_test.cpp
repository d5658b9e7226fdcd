// EXT_meshopt_compression: what meshoptimizer and gltfpack write, and damaged views.
#include "formats/gltf/gltf_meshopt.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/input.hpp"
#include "formats/glb/glb_container.hpp"
#include "formats/gltf/gltf.hpp"
#include "formats/gltf/gltf_remarks.hpp"
#include "formats/gltf_file.hpp"
#include "tests/formats/truncation.hpp"
#include "tests/support/errors.hpp"

namespace tureen {
namespace gltf_meshopt_test {

using nlohmann::json;
using test::error_of;
using test::ErrorIn;

constexpr std::size_t count = 48;

json extension(const char* mode, std::size_t stride, const char* filter = nullptr) {
  json view = {
      {"buffer", 0}, {"byteLength", 0}, {"byteStride", stride}, {"count", count}, {"mode", mode}};
  if (filter) view["filter"] = filter;
  return view;
}

std::vector<std::byte> decode(const json& view, const std::vector<unsigned char>& stored,
                              MemoryBudget budget = MemoryBudget()) {
  return decode_meshopt(JsonView(view, "scene.glb"), std::as_bytes(std::span(stored)), budget);
}

template <class T>
std::vector<unsigned char> encoded(const std::vector<T>& values, std::size_t stride) {
  const std::size_t elements = values.size() * sizeof(T) / stride;
  std::vector<unsigned char> stored(meshopt_encodeVertexBufferBound(elements, stride));
  stored.resize(
      meshopt_encodeVertexBuffer(stored.data(), stored.size(), values.data(), elements, stride));
  return stored;
}

template <class T>
std::vector<T> as(const std::vector<std::byte>& bytes) {
  std::vector<T> values(bytes.size() / sizeof(T));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
  return values;
}

/// Numbers without a pattern that a filter keeps: (89 i^2 mod 257) / 257.
float scattered(std::size_t i) { return float(89 * i * i % 257) / 257; }

TEST(GltfMeshopt, KeepsAttributesAndIndices) {
  std::vector<float> values(3 * count);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = scattered(i);
  EXPECT_EQ(as<float>(decode(extension("ATTRIBUTES", 12), encoded(values, 12))), values);

  std::vector<unsigned int> indices(count);
  for (std::size_t i = 0; i < count; ++i) indices[i] = unsigned(7 * i % 30);
  std::vector<unsigned char> stored(meshopt_encodeIndexSequenceBound(count, 30));
  stored.resize(meshopt_encodeIndexSequence(stored.data(), stored.size(), indices.data(), count));
  EXPECT_EQ(as<std::uint32_t>(decode(extension("INDICES", 4), stored)), indices);
  EXPECT_THAT(as<std::uint16_t>(decode(extension("INDICES", 2), stored)),
              ::testing::ElementsAreArray(indices));

  // The first index of a triangle may become another of its three.
  stored.resize(meshopt_encodeIndexBufferBound(count, 30));
  stored.resize(meshopt_encodeIndexBuffer(stored.data(), stored.size(), indices.data(), count));
  const auto triangles = as<std::uint16_t>(decode(extension("TRIANGLES", 2), stored));
  for (std::size_t i = 0; i < count; i += 3) {
    std::size_t turn = 0;
    while (turn < 3 && triangles[i] != indices[i + turn]) ++turn;
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_EQ(triangles[i + k], indices[i + (turn + k) % 3]) << "triangle " << i / 3;
  }
}

TEST(GltfMeshopt, AppliesFilters) {
  std::vector<float> directions(4 * count), numbers(count);
  for (std::size_t i = 0; i < count; ++i) {
    float* direction = &directions[4 * i];
    for (std::size_t k = 0; k < 4; ++k) direction[k] = scattered(4 * i + k) - 0.4f;
    numbers[i] = 100 * scattered(i);
  }
  const auto unit = [&](std::size_t i, std::size_t parts) {
    double length = 0;
    for (std::size_t k = 0; k < parts; ++k) length += std::pow(directions[4 * i + k], 2);
    for (std::size_t k = 0; k < parts; ++k) directions[4 * i + k] /= float(std::sqrt(length));
  };

  // 15 bits of mantissa: a relative error of 2^-15, of numbers below 128.
  std::vector<std::uint32_t> words(count);
  meshopt_encodeFilterExp(words.data(), count, 4, 16, numbers.data());
  const auto decoded =
      as<float>(decode(extension("ATTRIBUTES", 4, "EXPONENTIAL"), encoded(words, 4)));
  for (std::size_t i = 0; i < count; ++i) EXPECT_NEAR(decoded[i], numbers[i], 128 / 32768.0);

  // Shorts of 1 / 32767: an error of two steps from two roundings, and from the length.
  for (std::size_t i = 0; i < count; ++i) unit(i, 4);
  std::vector<std::int16_t> shorts(4 * count);
  meshopt_encodeFilterQuat(shorts.data(), count, 8, 16, directions.data());
  const auto turned =
      as<std::int16_t>(decode(extension("ATTRIBUTES", 8, "QUATERNION"), encoded(shorts, 8)));
  for (std::size_t i = 0; i < count; ++i) {
    double same = 0;
    for (std::size_t k = 0; k < 4; ++k) same += turned[4 * i + k] / 32767.0 * directions[4 * i + k];
    EXPECT_NEAR(std::abs(same), 1, 2 * 2 / 32767.0);
  }

  for (std::size_t i = 0; i < count; ++i) unit(i, 3);
  std::vector<std::int8_t> bytes(4 * count);
  meshopt_encodeFilterOct(bytes.data(), count, 4, 8, directions.data());
  const auto normals =
      as<std::int8_t>(decode(extension("ATTRIBUTES", 4, "OCTAHEDRAL"), encoded(bytes, 4)));
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t k = 0; k < 3; ++k)  // steps of 1 / 127, twice
      EXPECT_NEAR(normals[4 * i + k] / 127.0, directions[4 * i + k], 2 / 127.0);
}

TEST(GltfMeshopt, RejectsWhatDoesNotFit) {
  const std::vector<unsigned char> stored = encoded(std::vector<float>(3 * count), 12);
  const auto refusal = [&](const json& view) { return error_of([&] { decode(view, stored); }); };
  EXPECT_EQ(refusal(extension("ATTRIBUTES", 12)), std::nullopt);
  EXPECT_THAT(refusal(extension("VERTICES", 12)), ErrorIn("scene.glb", "mode", "VERTICES"));
  EXPECT_THAT(refusal(extension("ATTRIBUTES", 12, "LINEAR")),
              ErrorIn("scene.glb", "filter", "LINEAR"));
  for (const json& view :
       {extension("ATTRIBUTES", 0), extension("ATTRIBUTES", 10), extension("TRIANGLES", 12),
        extension("INDICES", 1), extension("ATTRIBUTES", 12, "OCTAHEDRAL"),
        extension("ATTRIBUTES", 12, "QUATERNION"), extension("INDICES", 4, "EXPONENTIAL")})
    EXPECT_THAT(refusal(view), ErrorIn("scene.glb", "do not fit"));
  json odd = extension("TRIANGLES", 4);
  odd["count"] = 47;
  EXPECT_THAT(refusal(odd), ErrorIn("scene.glb", 47, "TRIANGLES"));
  EXPECT_THAT(refusal(extension("ATTRIBUTES", 16)), ErrorIn("scene.glb", "damaged"));
  json large = extension("ATTRIBUTES", 256);
  large["count"] = 4294967295u;
  EXPECT_THAT(refusal(large), ErrorIn("scene.glb", "the view", "limit"));
}

/// gltfpack 1.3 with -cc wrote it from a grid of 4 x 4 vertices, (x, y, sin(x + 2 y)) with x, y in
/// 0..3 and the colours (x / 3, y / 3, 0.5).
std::vector<std::byte> packed_grid() {
  std::ifstream file(std::string(TUREEN_SOURCE_DIR) + "/tests/formats/data/gltfpack.glb",
                     std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  std::vector<std::byte> bytes(text.size());
  std::memcpy(bytes.data(), text.data(), text.size());
  return bytes;
}

Scene read_bytes(std::span<const std::byte> bytes) {
  Input input = Input::memory("packed.glb", bytes);
  return read_gltf_or_glb(input, std::filesystem::temp_directory_path(),
                          {.vertex_colors = VertexColorSpace::srgb});
}

TEST(GltfMeshopt, ReadsAFileOfGltfpack) {
  const Scene scene = read_bytes(packed_grid());
  const TriangleSoup& soup = only_soup(scene);
  ASSERT_EQ(soup.triangles.size(), 18u);
  ASSERT_EQ(soup.positions.size(), 16u);
  const auto& colors = std::get<VertexColors>(soup.appearance).rgba;
  const double step = 3.0 / 16383;  // of positions in 14 bits
  for (std::size_t i = 0; i < soup.positions.size(); ++i) {
    const glm::vec3 p = soup.positions[i];
    EXPECT_NEAR(p.x, std::round(p.x), step);
    EXPECT_NEAR(p.y, std::round(p.y), step);
    EXPECT_NEAR(p.z, std::sin(std::round(p.x) + 2 * std::round(p.y)), step);
    EXPECT_NEAR(colors[i].r, p.x / 3, 1 / 255.0);
    EXPECT_NEAR(colors[i].g, p.y / 3, 1 / 255.0);
    EXPECT_NEAR(colors[i].b, 0.5, 1 / 255.0);
  }
  for (const Remark& remark : scene.info.remarks)
    EXPECT_NE(remark.kind, &remarks::extensions_dropped);
}

TEST(GltfMeshopt, SurvivesDamage) {
  const std::vector<std::byte> whole = packed_grid();
  const auto read = [](std::span<const std::byte> bytes) { read_bytes(bytes); };
  EXPECT_EQ(test::survive_truncation(whole, read).read, 0u);
  EXPECT_GT(test::survive_damage(whole, read, test::Damage::one).refused, 0u);
}

TEST(GltfMeshopt, IsNamedWithoutADecoder) {
  const std::vector<std::byte> bytes = packed_grid();
  Input input = Input::memory("packed.glb", bytes);
  EXPECT_THAT(error_of([&] { read_gltf(input, read_glb_container(input), {}, {}); }),
              ErrorIn("packed.glb", "EXT_meshopt_compression"));
}

}  // namespace gltf_meshopt_test
}  // namespace tureen
