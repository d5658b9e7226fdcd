// TUREEN_triangle_soup: files restore the scene bit by bit, and damage gives a scene or an
// InputError.
#include "formats/tureen_glb/tureen_glb.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <limits>

#include "base/memory_budget.hpp"
#include "formats/tureen_glb/tureen_glb_remarks.hpp"
#include "image/srgb.hpp"
#include "scene/edit/edits.hpp"
#include "scene/edit/mean_color.hpp"
#include "scene/edit/opaque_windows.hpp"
#include "tests/formats/truncation.hpp"
#include "tests/formats/tureen_glb/glb_schema.hpp"
#include "tests/formats/tureen_glb/tureen_glb_kinds.hpp"
#include "tests/support/errors.hpp"

namespace tureen {
namespace tureen_glb_test {

using test::error_of;
using test::ErrorIn;
using test::fill_soup;
using test::RandomScene;
using ::testing::HasSubstr;

Scene read_back(std::span<const std::byte> bytes) {
  Input input = Input::memory("memory.glb", bytes);
  return read_tureen_glb(input);
}

class TureenGlb : public ::testing::TestWithParam<test::GlbKind> {};

TEST_P(TureenGlb, ComesBackToTheBit) {
  for (const unsigned seed : {1u, 2u, 3u})
    for (const std::size_t faces : {std::size_t(1), std::size_t(17)}) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", faces " + std::to_string(faces));
      const Scene scene = test::random_scene(GetParam(), seed, faces);
      const Scene back = read_back(test::glb_bytes(scene, GetParam().name));
      EXPECT_EQ(test::difference(scene, back), "");
    }
}

TEST_P(TureenGlb, EmptyComesBackToo) {
  const Scene scene = test::random_scene(GetParam(), 4, 0);
  EXPECT_EQ(test::difference(scene, read_back(test::glb_bytes(scene, GetParam().name))), "");
}

/// Damages the frame, the JSON and the first bytes of the binary chunk: all later bytes are values.
void expect_survival(const test::GlbKind& kind, test::Damage damage) {
  RandomScene random(5);
  Scene scene = scene_of(TriangleSoup{});
  kind.fill(random, scene, 1);
  const auto bytes = test::glb_bytes(scene, kind.name);
  const auto read = [](std::span<const std::byte> damaged) {
    EXPECT_FALSE(test::scene_defect(read_back(damaged)));
  };
  EXPECT_EQ(test::survive_truncation(bytes, read).read, 0u);
  std::uint32_t json_size = 0;
  std::memcpy(&json_size, bytes.data() + 12, 4);
  std::vector<std::byte> head(bytes);
  test::Survival survival;
  const std::size_t reach = std::min<std::size_t>(bytes.size(), 20 + json_size + 200);
  constexpr std::array flips{0x01u, 0x02u, 0x04u, 0x10u, 0x40u, 0x80u, 0xffu};
  for (std::size_t i = 0; i < reach; ++i)
    for (std::size_t k = 0; k < flips.size(); ++k) {
      if (damage == test::Damage::one && k != i % flips.size()) continue;
      head[i] = bytes[i] ^ std::byte(flips[k]);
      test::expect_survival(
          head, read, "byte " + std::to_string(i) + " xor " + std::to_string(flips[k]), survival);
      head[i] = bytes[i];
    }
  const std::size_t ways = damage == test::Damage::one ? flips.size() : 1;
  EXPECT_GT(ways * survival.refused, reach);
}

/// Most ways of damaging a name occur in some kind of file, since names repeat at other positions.
TEST_P(TureenGlb, SurvivesTruncationAndDamage) { expect_survival(GetParam(), test::Damage::one); }

class TureenGlbDamage : public ::testing::TestWithParam<test::GlbKind> {};

TEST_P(TureenGlbDamage, OfEveryKindIsSurvived) { expect_survival(GetParam(), test::Damage::every); }

INSTANTIATE_TEST_SUITE_P(Thorough, TureenGlbDamage, ::testing::ValuesIn(test::every_glb_kind()),
                         [](const auto& test) { return std::string(test.param.name); });

class TureenGlbMesh : public ::testing::TestWithParam<test::GlbKind> {};

TEST_P(TureenGlbMesh, DrawsTheMeanColoursAsLinear16Bit) {
  const Scene scene = test::random_scene(GetParam(), 6, 9);
  // A preview shows soft triangles with the mean of their harmonics, at any opacity.
  const auto* splats = std::get_if<Splats>(&only_layer(scene).primitives);
  const TriangleSoup soup = splats ? to_opaque(*splats, 0.0f).soup : only_soup(scene);
  const auto bytes = test::glb_bytes(scene, GetParam().name);
  const auto json = test::glb_json(bytes);
  const auto& primitive = json["meshes"][0]["primitives"][0];
  const auto& position = json["accessors"][primitive["attributes"]["POSITION"].get<int>()];
  const auto& color = json["accessors"][primitive["attributes"]["COLOR_0"].get<int>()];
  EXPECT_EQ(position["count"], color["count"]);
  EXPECT_EQ(color["componentType"], 5123);
  EXPECT_EQ(color["normalized"], true);
  std::uint32_t json_size = 0;
  std::memcpy(&json_size, bytes.data() + 12, 4);
  const auto view_offset = [&](const nlohmann::json& accessor) {
    return 28 + json_size +
           json["bufferViews"][accessor["bufferView"].get<int>()]["byteOffset"].get<std::size_t>();
  };
  const std::size_t colors_at = view_offset(color);
  std::vector<std::uint32_t> indices(3 * soup.triangles.size());
  for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = std::uint32_t(i);
  if (primitive.contains("indices"))
    std::memcpy(indices.data(),
                bytes.data() + view_offset(json["accessors"][primitive["indices"].get<int>()]),
                indices.size() * 4);
  const auto means = mean_colors(soup);
  const auto* vertex_colors = std::get_if<VertexColors>(&soup.appearance);
  for (std::size_t c = 0; c < indices.size(); ++c) {
    glm::u16vec4 stored;
    std::memcpy(&stored, bytes.data() + colors_at + 8 * std::size_t(indices[c]), 8);
    const glm::vec3 wanted = vertex_colors
                                 ? glm::vec3(vertex_colors->rgba[soup.triangles[c / 3][int(c % 3)]])
                                 : means[c / 3];
    for (int k = 0; k < 3; ++k)
      // Half a step of 16 bits, and a hundredth for the arithmetic.
      EXPECT_NEAR(stored[k] / 65535.0, linear_from_srgb(double(wanted[k])), 0.51 / 65535.0);
    EXPECT_EQ(stored.w, 65535);
  }
}

INSTANTIATE_TEST_SUITE_P(Appearance, TureenGlb, ::testing::ValuesIn(test::every_glb_kind()),
                         [](const auto& test) { return std::string(test.param.name); });
INSTANTIATE_TEST_SUITE_P(Appearance, TureenGlbMesh, ::testing::ValuesIn(test::glb_kinds()),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(TureenGlbFile, KeepsNanPositionsAndHugeValues) {
  RandomScene random(7);
  Scene scene = random.scene();
  TriangleSoup soup = random.geometry(2, false);
  soup.positions[1].y = std::numeric_limits<float>::quiet_NaN();
  soup.positions[4].x = -std::numeric_limits<float>::infinity();
  fill_soup(scene, std::move(soup), FaceColors{{{-0.0f, 2.0f, 0.5f, 1.0f}, {0, 0, 0, 1}}});
  EXPECT_EQ(test::difference(scene, read_back(test::glb_bytes(scene, "nan"))), "");
}

TEST(TureenGlbFile, SplitsManyTexelsIntoStrips) {
  RandomScene random(8);
  Scene scene = random.scene();
  // 130 faces of level 7 have 1,090,050 texels: a full strip of 2^20 and a partial one.
  fill_soup(scene, random.geometry(130, false), random.lattice_texture(130, 7, false));
  const auto bytes = test::glb_bytes(scene, "strips");
  EXPECT_EQ(test::glb_json(bytes)["extensions"][tureen_extension]["appearance"]["strips"].size(),
            2u);
  EXPECT_EQ(test::difference(scene, read_back(bytes)), "");
}

TEST(TureenGlbFile, StoresColoursThatAreBytesAsBytes) {
  RandomScene random(9);
  Scene scene = scene_of(TriangleSoup{});
  fill_soup(scene, random.geometry(3, false), FaceColors{random.colors(3, true)});
  const auto json = test::glb_json(test::glb_bytes(scene, "bytes"));
  const int rgba = json["extensions"][tureen_extension]["appearance"]["rgba"];
  EXPECT_EQ(json["accessors"][rgba]["componentType"], 5121);
}

TEST(TureenGlbFile, RefusesWhatItCannotHoldOrKnow) {
  RandomScene random(10);
  Scene scene = random.scene();
  fill_soup(scene, random.geometry(2, false), FaceColors{random.colors(2, true)});
  const auto bytes = test::glb_bytes(scene, "refused");
  const auto expect_refusal = [&](const std::function<void(nlohmann::json&)>& change,
                                  const auto&... values) {
    auto json = test::glb_json(bytes);
    change(json);
    EXPECT_THAT(error_of([&] { read_back(test::with_glb_json(bytes, json)); }),
                ErrorIn("memory.glb", values...));
  };
  const char* x = tureen_extension;
  for (const int version : {0, 2, 6})
    expect_refusal([&](auto& j) { j["extensions"][x]["version"] = version; }, version, 3, 4, 5);
  expect_refusal([&](auto& j) { j["extensions"][x].erase("up"); }, "up");
  expect_refusal([&](auto& j) { j["extensions"][x]["face_count"] = 3; }, 9, 6);
  expect_refusal([&](auto& j) { j["extensions"][x]["vertex_count"] = 7; }, 6, 7);
  expect_refusal([&](auto& j) { j["extensions"][x]["appearance"]["type"] = "plaid"; },
                 "extensions.TUREEN_triangle_soup.appearance.type", "plaid");
  expect_refusal([&](auto& j) { j["accessors"][0]["count"] = 4000000000u; }, "accessors[0]",
                 "4000000000", 12);
  expect_refusal([&](auto& j) { j["bufferViews"][0]["byteOffset"] = 1u << 30; }, "bufferViews[0]");
  expect_refusal([&](auto& j) { j["accessors"][0]["type"] = "VEC2"; }, "VEC3");
  expect_refusal([&](auto& j) { j["bufferViews"][0]["byteStride"] = 16; }, "bufferViews[0]");
  expect_refusal([&](auto& j) { j["extensions"][x]["cameras"][0]["width"] = -1; },
                 "cameras[0].width", -1);
  expect_refusal([&](auto& j) { j["extensions"][x]["cameras"][0]["width"] = 2147483647; },
                 "cameras[0].width", 2147483647, 65536);
  expect_refusal([&](auto& j) { j["extensions"][x]["cameras"][0]["height"] = 0; },
                 "cameras[0].height");
  expect_refusal([&](auto& j) { j["extensions"][x]["up"] = {0, 0, 0}; }, "up");
  const auto expect_view_refusal = [&](const char* key, const nlohmann::json& value,
                                       const char* reason) {
    expect_refusal([&](auto& j) { j["extensions"][x]["first_view"][key] = value; }, "first_view",
                   reason);
  };
  expect_view_refusal("width", 0, "width");
  expect_view_refusal("fx", 0, "without a focal length");
  expect_view_refusal("fy", -1e308, "without a focal length");
  expect_view_refusal("view_from_world", {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1},
                      "no rotation");
  expect_view_refusal("view_from_world", {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0},
                      "no rotation");
  expect_view_refusal("view_from_world", {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
                      "mirrored");
  expect_view_refusal("view_from_world", {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
                      "no rotation");
  expect_view_refusal("view_from_world", {1e308, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
                      "no rotation");
  expect_refusal([&](auto& j) { j["extensions"][x]["first_view"] = 3; }, "first_view");

  // The writer rejects scenes that the reader would reject.
  const Scene good = scene;
  scene.cameras[0].width = 65537;
  EXPECT_THROW(write_tureen_glb(scene, test::temporary_glb("never")), UsageError);
  scene = good;
  scene.info.up = glm::vec3(0);
  EXPECT_THROW(write_tureen_glb(scene, test::temporary_glb("never")), UsageError);
  scene = good;
  scene.cameras[0].fx = std::numeric_limits<double>::infinity();
  EXPECT_THROW(write_tureen_glb(scene, test::temporary_glb("never")), UsageError);
  scene = good;
  scene.first_view->view_from_world[0] *= 2;
  EXPECT_THROW(write_tureen_glb(scene, test::temporary_glb("never")), UsageError);
  EXPECT_FALSE(std::filesystem::exists(test::temporary_glb("never")));
}

// -- quality, and presets in files of earlier versions -------------------------------------------

constexpr Quality qualities[] = {
    {},
    {.resolution_scale = 0.3},
    {.supersampling = 3},
    {.splat_order = Quality::SplatOrder::exact},
    {.supersampling = 2, .splat_order = Quality::SplatOrder::stochastic}};

/// Three faces of levels 0, 2 and 3. The file stores levels in an accessor with a byte for each
/// face. As a choice of faces, it selects all but the first.
Scene scene_of_levels() {
  RandomScene random(13);
  Scene scene = random.scene();
  LatticeTexture texture = random.lattice_texture(3, 3, false);
  texture.patches[0].level = 0;
  texture.patches[1].level = 2;
  texture.mlp = random.diffsoup_mlp();
  fill_soup(scene, random.geometry(3, false), std::move(texture));
  return scene;
}

/// The bytes of this scene, with a preset in its JSON.
std::vector<std::byte> with_preset(const Scene& scene, const nlohmann::json& preset) {
  const auto bytes = test::glb_bytes(scene, "preset");
  auto json = test::glb_json(bytes);
  auto& extension = json["extensions"][tureen_extension];
  extension["preset"] = preset;
  if (preset.contains("keeps_face"))
    extension["preset"]["keeps_face"] = extension["appearance"]["levels"];
  return test::with_glb_json(bytes, json);
}

const nlohmann::json earlier_preset = {{"lattice_level", 2},    {"color", "harmonics"},
                                       {"harmonics_degree", 0}, {"triangle_fraction", 0.7},
                                       {"keeps_face", nullptr}, {"supersampling", 2}};

TEST(TureenGlbQuality, ComesBack) {
  for (const Quality& quality : qualities) {
    SCOPED_TRACE(describe(quality));
    Scene scene = scene_of_levels();
    scene.quality = quality;
    const auto bytes = test::glb_bytes(scene, "quality");
    EXPECT_EQ(test::difference(scene, read_back(bytes)), "");
    const auto extension = test::glb_json(bytes)["extensions"][tureen_extension];
    EXPECT_EQ(extension.contains("preset"), quality != Quality{});
  }
}

TEST(TureenGlbSchema, HoldsForEveryFile) {
  test::SchemaPairs pairs;
  const auto kinds = test::every_glb_kind();
  for (const auto& kind : kinds)
    test::add_extensions(pairs,
                         test::glb_json(test::glb_bytes(test::random_scene(kind, 3, 2), "kind")));
  test::add_extensions(pairs,
                       test::glb_json(test::glb_bytes(test::layered_scene(kinds, 3, 2), "layers")));
  for (const Quality& quality : qualities) {
    Scene scene = scene_of_levels();
    scene.quality = quality;
    test::add_extensions(pairs, test::glb_json(test::glb_bytes(scene, "quality")));
  }
  const auto count = [&](const std::string& definition) {
    return std::count_if(pairs.begin(), pairs.end(),
                         [&](const auto& pair) { return pair.first == definition; });
  };
  EXPECT_GE(count("layer"), std::ptrdiff_t(kinds.size()));
  EXPECT_GE(count("splats"), 6);
  const int invalid = test::invalid_values(pairs);
  if (invalid == 77) GTEST_SKIP() << "python3-jsonschema is not installed";
  EXPECT_EQ(invalid, 0);
}

/// The validator must find each kind of fault, or the test above proves nothing.
TEST(TureenGlbSchema, IsBrokenByEachKindOfFault) {
  const auto root =
      test::glb_json(test::glb_bytes(scene_of_levels(), "fault"))["extensions"][tureen_extension];
  test::SchemaPairs pairs;
  for (const auto& [pointer, value] : std::vector<std::pair<std::string, nlohmann::json>>{
           {"/unknown", 1},                  // a key that the schema lacks
           {"/appearance/vertex_count", 1},  // a key in a wrong place
           {"/version", "3"},                // a wrong type
           {"/appearance/level", 8},         // out of range
           {"/appearance/type", "lattice"}}) {
    pairs.emplace_back("", root);
    pairs.back().second[nlohmann::json::json_pointer(pointer)] = value;
  }
  pairs.emplace_back("", root);
  pairs.back().second.erase("face_count");
  const int invalid = test::invalid_values(pairs);
  if (invalid == 77) GTEST_SKIP() << "python3-jsonschema is not installed";
  EXPECT_EQ(invalid, int(pairs.size()));
}

TEST(TureenGlbQuality, AnUnknownSplatOrderIsAnError) {
  try {
    read_back(with_preset(scene_of_levels(), {{"splat_order", "sideways"}}));
    ADD_FAILURE() << "no error";
  } catch (const InputError& error) {
    EXPECT_EQ(error.reason(),
              "extensions.TUREEN_triangle_soup.preset.splat_order: \"sideways\" is not supported; "
              "expected one of centre, exact, stochastic");
  }
}

TEST(TureenGlbQuality, WhatCannotBeDrawnIsNotWritten) {
  Scene scene = scene_of_levels();
  scene.quality.supersampling = 9;
  EXPECT_THROW(write_tureen_glb(scene, test::temporary_glb("never")), UsageError);
  EXPECT_FALSE(std::filesystem::exists(test::temporary_glb("never")));
}

TEST(TureenGlbEarlierPreset, IsReadAsAnEdit) {
  const Scene scene = scene_of_levels();
  const Scene back = read_back(with_preset(scene, earlier_preset));
  const TriangleSoup expected =
      edited(only_soup(scene),
             {.keeps_face = {0, 1, 1}, .lattice_level = 2, .color = Edits::Color::baked});
  const auto& soup = only_soup(back);
  EXPECT_EQ(soup.positions, expected.positions);
  EXPECT_EQ(soup.triangles, expected.triangles);
  const auto& texture = std::get<LatticeTexture>(soup.appearance);
  EXPECT_EQ(texture.texels, std::get<LatticeTexture>(expected.appearance).texels);
  EXPECT_FALSE(texture.mlp);
  EXPECT_EQ(back.quality, (Quality{.supersampling = 2}));
  ASSERT_EQ(back.info.remarks.size(), 1u);
  EXPECT_EQ(
      back.info.remarks[0],
      (Remark{&remarks::preset_applied,
              {{"edits", std::vector<std::string>{"keeps_face", "lattice_level", "color"}}}}));
}

TEST(TureenGlbEarlierPreset, SettingsThatAreGoneAreIgnoredWithANote) {
  const Scene scene = scene_of_levels();
  const Scene back = read_back(with_preset(scene, {{"texel_bits", 4},
                                                   {"color", "harmonics"},
                                                   {"feature_storage", "rgba8"},
                                                   {"site", "forward"},
                                                   {"alpha_to_coverage", 4},
                                                   {"promised_psnr_db", 51.5},
                                                   {"supersampling", 3}}));
  EXPECT_EQ(back.quality, (Quality{.supersampling = 3}));
  ASSERT_EQ(back.info.remarks.size(), 1u);
  EXPECT_EQ(back.info.remarks[0].kind, &remarks::preset_keys_ignored);
  EXPECT_EQ(std::get<std::vector<std::string>>(back.info.remarks[0].fields.at(0).value),
            (std::vector<std::string>{"texel_bits", "color", "feature_storage", "site",
                                      "alpha_to_coverage", "promised_psnr_db"}));
  EXPECT_EQ(std::get<LatticeTexture>(only_soup(back).appearance).texels,
            std::get<LatticeTexture>(only_soup(scene).appearance).texels);
}

TEST(TureenGlbEarlierPreset, WhatNoVersionHadIsIgnored) {
  const Scene scene = scene_of_levels();
  const auto bytes = with_preset(scene, {{"colour_of_the_frame", {"red", 1}}});
  EXPECT_EQ(test::difference(scene, read_back(bytes)), "");
}

TEST(TureenGlbEarlierPreset, BadValuesAreRefusedWithTheirPlace) {
  const Scene scene = scene_of_levels();
  const auto refusal = [&](const nlohmann::json& preset) {
    return error_of([&] { read_back(with_preset(scene, preset)); });
  };
  EXPECT_THAT(refusal({{"lattice_level", 8}}), ErrorIn("memory.glb", "preset.lattice_level", 8, 7));
  EXPECT_THAT(refusal({{"lattice_level", "low"}}), ErrorIn("memory.glb", "preset.lattice_level"));
  EXPECT_THAT(refusal({{"texel_bits", 12}}), ErrorIn("memory.glb", "preset.texel_bits", 4, 8, 16));
  EXPECT_THAT(refusal({{"color", "plaid"}}), ErrorIn("memory.glb", "preset.color", "plaid"));
  EXPECT_THAT(refusal({{"harmonics_degree", 3}}),
              ErrorIn("memory.glb", "preset.harmonics_degree", 3, 2));
  EXPECT_THAT(refusal({{"resolution_scale", 2}}), ErrorIn("memory.glb", "preset", "0.25", 1));
  EXPECT_THAT(refusal({{"supersampling", 0}}), ErrorIn("memory.glb", "preset", 1, 8));
  EXPECT_THAT(refusal(7), ErrorIn("memory.glb", "preset"));
  // An accessor of another kind, and a missing one.
  const auto bytes = test::glb_bytes(scene, "preset");
  for (const int accessor : {0, 999999}) {
    auto json = test::glb_json(bytes);
    json["extensions"][tureen_extension]["preset"]["keeps_face"] = accessor;
    EXPECT_THROW(read_back(test::with_glb_json(bytes, json)), InputError) << accessor;
  }
}

// A few bytes that ask for gigabytes: partly shared texels are not shared at a lower level.
TEST(TureenGlbEarlierPreset, WhatItMakesOfTheTexelsIsCountedBefore) {
  RandomScene random(14);
  Scene scene = random.scene();
  constexpr std::size_t faces = 4000;
  LatticeTexture texture = random.lattice_texture(1, 7, false);
  const auto& bytes = std::get<std::vector<std::uint8_t>>(texture.texels);
  std::vector<std::uint8_t> longer(bytes.size() + faces * LatticeTexture::channels, 200);
  texture.texels = longer;
  texture.patches.clear();
  for (std::uint32_t t = 0; t < faces; ++t) texture.patches.push_back({t, 7});
  fill_soup(scene, random.geometry(faces, false), std::move(texture));
  const auto file = with_preset(scene, {{"lattice_level", 6}});
  const std::uint64_t before = max_memory();
  set_max_memory(16 << 20);  // of 4,000 x 2,145 x 8 needed bytes
  EXPECT_THROW(read_back(file), InputError);
  set_max_memory(before);
}

TEST(TureenGlbEarlierPreset, SurvivesTruncationAndDamage) {
  const auto bytes = with_preset(scene_of_levels(), earlier_preset);
  const auto read = [](std::span<const std::byte> damaged) {
    const Scene back = read_back(damaged);
    EXPECT_FALSE(defect(only_soup(back)));
    EXPECT_FALSE(defect(back.quality));
  };
  EXPECT_EQ(test::survive_truncation(bytes, read).read, 0u);
  // Damages every byte of the preset's JSON.
  const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::size_t first = text.find("\"preset\""), last = text.find('}', first);
  ASSERT_NE(last, std::string::npos);
  std::vector<std::byte> damaged(bytes);
  test::Survival survival;
  for (std::size_t i = first; i <= last; ++i)
    for (const unsigned flip : {0x01u, 0x02u, 0x04u, 0x10u, 0x40u, 0x80u, 0xffu}) {
      damaged[i] = bytes[i] ^ std::byte(flip);
      test::expect_survival(damaged, read, "byte " + std::to_string(i), survival);
      damaged[i] = bytes[i];
    }
  EXPECT_GT(survival.refused, 0u);
}

TEST(TureenGlbFile, RefusesImagesNamedTwice) {
  RandomScene random(11);
  Scene scene = scene_of(TriangleSoup{});
  TriangleSoup soup = random.geometry(2, false);
  UvTextures textures = random.uv_textures(soup, false);
  fill_soup(scene, std::move(soup), std::move(textures));
  const auto bytes = test::glb_bytes(scene, "twice");
  auto json = test::glb_json(bytes);
  json["extensions"][tureen_extension]["appearance"]["images"] = {0, 0, 1};
  EXPECT_THAT(error_of([&] { read_back(test::with_glb_json(bytes, json)); }),
              ErrorIn("memory.glb"));
}

TEST(TureenGlbFile, SaysWhenATextIsNotUtf8) {
  Scene scene = scene_of(TriangleSoup{});
  scene.info.name = "caf\xE9";
  const auto path = test::temporary_glb("latin");
  const auto losses = write_tureen_glb(scene, path);
  ASSERT_EQ(losses.size(), 1u);
  EXPECT_THAT(losses[0], HasSubstr("UTF-8"));
  Input input = Input::open(path);
  EXPECT_EQ(read_tureen_glb(input).info.name, "caf\xEF\xBF\xBD");
  std::filesystem::remove(path);
}

TEST(TureenGlbFile, ReportsProgressUpToOne) {
  RandomScene random(12);
  Scene scene = scene_of(TriangleSoup{});
  fill_soup(scene, random.geometry(5, true), FaceColors{random.colors(5, false)});
  const auto bytes = test::glb_bytes(scene, "progress");
  std::vector<double> seen;
  Input input = Input::memory("memory.glb", bytes);
  read_tureen_glb(input, {.progress = [&](double fraction) { seen.push_back(fraction); }});
  ASSERT_FALSE(seen.empty());
  EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
  EXPECT_EQ(seen.back(), 1.0);
}

}  // namespace tureen_glb_test
}  // namespace tureen
