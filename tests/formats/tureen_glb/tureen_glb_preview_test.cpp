// A scene from the first bytes of its file equals the scene of the whole file.
#include "formats/tureen_glb/tureen_glb_preview.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <stdexcept>

#include "formats/tureen_glb/tureen_glb_compressed.hpp"
#include "scene/edit/mean_color.hpp"
#include "scene/edit/opaque_windows.hpp"
#include "tests/formats/truncation.hpp"
#include "tests/formats/tureen_glb/tureen_glb_kinds.hpp"
#include "tests/support/errors.hpp"

namespace tureen {
namespace tureen_glb_preview_test {

using test::error_of;
using test::ErrorIn;
using test::fill_soup;
using test::RandomScene;
using Bytes = std::span<const std::byte>;

/// Half a step of 16 bits in linear light plus a hundredth for the arithmetic, times the steepest
/// slope of the transfer function: 12.92 near black.
constexpr float color_tolerance = 12.92f * 0.51f / 65535.0f;

std::optional<std::uint64_t> size_of(Bytes prefix) {
  const auto size = tureen_glb_preview_size(prefix, "arriving.glb");
  return size ? std::optional(size->bytes) : std::nullopt;
}

std::optional<Scene> preview_of(Bytes prefix) {
  return read_tureen_glb_preview(prefix, "arriving.glb");
}

/// Length in bytes of the JSON chunk and the next header. With these bytes, the size of a preview
/// is known.
std::size_t beginning_of(Bytes bytes) {
  std::uint32_t json_size = 0;
  std::memcpy(&json_size, &bytes[12], 4);
  return std::min<std::size_t>(20 + json_size + 8, bytes.size());
}

TriangleSoup soup_of(const Scene& scene) {
  // A preview shows soft triangles as hard ones, at any opacity.
  const auto* splats = std::get_if<Splats>(&only_layer(scene).primitives);
  return splats ? to_opaque(*splats, 0.0f).soup : only_soup(scene);
}

TEST(GlbPreviewOfSplats, HasTheColorsOfDegreeZero) {
  for (const test::GlbKind& kind : test::splat_glb_kinds()) {
    SCOPED_TRACE(kind.name);
    const Scene whole = test::random_scene(kind, 1, 3);
    const auto& splats = std::get<Splats>(only_layer(whole).primitives);
    const std::vector<std::byte> bytes = test::glb_bytes(whole, kind.name);
    const std::uint64_t size = size_of(bytes).value();
    EXPECT_EQ(size_of(Bytes(bytes).first(beginning_of(bytes))), size);
    if (std::holds_alternative<TriangleWindows>(splats.kernel)) {
      EXPECT_EQ(size, 0u);
      EXPECT_FALSE(preview_of(bytes));
      continue;
    }
    EXPECT_TRUE(tureen_glb_preview_size(bytes, "arriving.glb")->has_splats);
    EXPECT_FALSE(preview_of(Bytes(bytes).first(std::size_t(size) - 1)));
    std::optional<Scene> preview = preview_of(Bytes(bytes).first(std::size_t(size)));
    ASSERT_TRUE(preview);
    Scene expected = whole;
    auto& color = std::get<Splats>(only_layer(expected).primitives).color;
    const std::size_t stride = coefficients_per_splat(color);
    for (std::size_t i = 0; i < count(splats); ++i)
      color.coefficients[i] = splats.color.coefficients[stride * i];
    color.coefficients.resize(count(splats));
    color.degree = 0;
    EXPECT_EQ(test::difference(*preview, expected), "");
  }
}

void expect_survival_of_splats(test::Damage damage) {
  for (const test::GlbKind& kind : test::splat_glb_kinds()) {
    const std::vector<std::byte> bytes = test::glb_bytes(test::random_scene(kind, 4, 1), kind.name);
    const std::size_t size = std::size_t(size_of(bytes).value());
    if (size == 0) continue;
    const auto read = [](Bytes damaged) {
      const std::optional<Scene> preview = preview_of(damaged);
      if (preview) {
        EXPECT_FALSE(defect(std::get<Splats>(only_layer(*preview).primitives)));
      }
    };
    EXPECT_GT(test::survive_damage(Bytes(bytes).first(size), read, damage).refused, 0u)
        << kind.name;
  }
}

TEST(GlbPreviewOfSplats, SurvivesDamage) { expect_survival_of_splats(test::Damage::one); }

TEST(ThoroughGlbPreviewOfSplats, SurvivesDamage) { expect_survival_of_splats(test::Damage::every); }

class GlbPreview : public ::testing::TestWithParam<test::GlbKind> {};

TEST_P(GlbPreview, ShowsWhatTheWholeFileSays) {
  for (const unsigned seed : {1u, 2u}) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Scene whole = test::random_scene(GetParam(), seed, 23);
    const TriangleSoup soup = soup_of(whole);
    const std::vector<std::byte> bytes = test::glb_bytes(whole, GetParam().name);
    const auto size = size_of(bytes);
    ASSERT_TRUE(size && *size > beginning_of(bytes) && *size < bytes.size());
    EXPECT_EQ(size_of(Bytes(bytes).first(std::size_t(*size))), size);
    EXPECT_FALSE(preview_of(Bytes(bytes).first(std::size_t(*size) - 1)));
    std::optional<Scene> preview = preview_of(Bytes(bytes).first(std::size_t(*size)));
    ASSERT_TRUE(preview);
    const TriangleSoup shown = only_soup(*preview);
    EXPECT_FALSE(defect(shown));
    EXPECT_TRUE(test::same_bits(shown.positions, soup.positions));
    EXPECT_TRUE(test::same_bits(shown.triangles, soup.triangles));
    only_layer(*preview).primitives = only_layer(whole).primitives;
    EXPECT_EQ(test::difference(*preview, whole), "") << "except the primitives";

    const auto expect_color = [](const glm::vec4& color, const glm::vec3& wanted) {
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(color[k], wanted[k], color_tolerance);
      EXPECT_EQ(color.w, 1.0f);
    };
    if (const auto* wanted = std::get_if<VertexColors>(&soup.appearance)) {
      const auto& rgba = std::get<VertexColors>(shown.appearance).rgba;
      ASSERT_EQ(rgba.size(), wanted->rgba.size());
      for (std::size_t i = 0; i < rgba.size(); ++i)
        expect_color(rgba[i], glm::vec3(wanted->rgba[i]));
    } else {
      const std::vector<glm::vec3> means = mean_colors(soup);
      const auto& rgba = std::get<FaceColors>(shown.appearance).rgba;
      ASSERT_EQ(rgba.size(), means.size());
      for (std::size_t t = 0; t < rgba.size(); ++t) expect_color(rgba[t], means[t]);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Appearance, GlbPreview, ::testing::ValuesIn(test::glb_kinds()),
                         [](const auto& test) { return std::string(test.param.name); });

/// The kinds of mesh in a file: with or without its own triangles, as a copy beside the soup's
/// vertices, and with a colour for each vertex.
std::vector<test::GlbKind> mesh_kinds() {
  std::vector<test::GlbKind> kinds = test::glb_kinds();
  const auto is_other = [](const test::GlbKind& kind) {
    const std::string name = kind.name;
    return name != "face_bytes" && name != "lattice_bytes_mlp_shared" &&
           name != "vertex_bytes_shared";
  };
  kinds.erase(std::remove_if(kinds.begin(), kinds.end(), is_other), kinds.end());
  if (kinds.size() != 3) throw std::logic_error("glb_kinds() lacks one of the three kinds");
  return kinds;
}

class GlbPreviewMesh : public GlbPreview {};

TEST_P(GlbPreviewMesh, AsksForMoreAtEveryLengthThatIsTooShort) {
  const Scene whole = test::random_scene(GetParam(), 3, 1);
  const std::vector<std::byte> bytes = test::glb_bytes(whole, GetParam().name);
  const std::uint64_t size = size_of(bytes).value();
  const std::size_t beginning = beginning_of(bytes);
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    // A copy of exactly this size, so that a sanitizer detects a read past the end.
    const std::vector<std::byte> prefix(bytes.begin(), bytes.begin() + std::ptrdiff_t(length));
    const auto known = size_of(prefix);
    ASSERT_EQ(known.has_value(), length >= beginning) << length;
    if (known) {
      ASSERT_EQ(*known, size) << length;
    }
    ASSERT_EQ(preview_of(prefix).has_value(), length >= size) << length;
  }
}

void expect_survival(const test::GlbKind& kind, test::Damage damage) {
  RandomScene random(4);
  Scene scene = scene_of(TriangleSoup{});
  kind.fill(random, scene, 1);
  const std::vector<std::byte> bytes = test::glb_bytes(scene, kind.name);
  const std::size_t size = std::size_t(size_of(bytes).value());
  std::size_t shown = 0;
  const auto read = [&](Bytes damaged) {
    const std::optional<Scene> preview = preview_of(damaged);
    if (!preview) return;
    ++shown;
    EXPECT_FALSE(defect(only_soup(*preview)));
  };
  const test::Survival survival = test::survive_damage(Bytes(bytes).first(size), read, damage);
  EXPECT_GT((damage == test::Damage::one ? 11 : 1) * survival.refused, size);
  EXPECT_GT(shown, 0u);
}

TEST_P(GlbPreviewMesh, SurvivesDamage) { expect_survival(GetParam(), test::Damage::one); }

class GlbPreviewDamage : public ::testing::TestWithParam<test::GlbKind> {};

TEST_P(GlbPreviewDamage, OfEveryKindIsSurvived) {
  expect_survival(GetParam(), test::Damage::every);
}

INSTANTIATE_TEST_SUITE_P(Thorough, GlbPreviewDamage, ::testing::ValuesIn(mesh_kinds()),
                         [](const auto& test) { return std::string(test.param.name); });

INSTANTIATE_TEST_SUITE_P(Kind, GlbPreviewMesh, ::testing::ValuesIn(mesh_kinds()),
                         [](const auto& test) { return std::string(test.param.name); });

// -- Files that have none -------------------------------------------------------------------------

TEST(GlbPreviewFile, OtherFilesHaveNone) {
  Scene scene = scene_of(TriangleSoup{});
  RandomScene random(5);
  fill_soup(scene, random.geometry(3, false), FaceColors{random.colors(3, true)});
  const std::vector<std::byte> bytes = test::glb_bytes(scene, "foreign");
  auto json = test::glb_json(bytes);
  json.erase("extensions");
  const std::vector<std::byte> foreign = test::with_glb_json(bytes, json);
  EXPECT_EQ(size_of(foreign), 0u);
  EXPECT_FALSE(preview_of(foreign));

  const std::string off = "COFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  const Bytes text = std::as_bytes(std::span(off));
  EXPECT_EQ(size_of(text.first(3)), std::nullopt) << "it may still be a GLB";
  EXPECT_EQ(size_of(text.first(4)), 0u);
  EXPECT_FALSE(preview_of(text));
}

TEST(GlbPreviewFile, CompressedFilesAndEmptySoupsHaveNone) {
  RandomScene random(6);
  Scene scene = random.scene();
  TriangleSoup soup = random.geometry(4, true);
  soup.appearance = random.lattice_texture(4, 1, false);
  only_soup(scene) = soup;
  const auto path = test::temporary_glb("compressed_preview");
  write_compressed_glb(scene, encode_compressed(soup, {}), path);
  const std::vector<std::byte> compressed = Input::open(path).read_rest();
  std::filesystem::remove(path);
  EXPECT_EQ(size_of(compressed), 0u);
  EXPECT_FALSE(preview_of(compressed));

  fill_soup(scene, {}, FaceColors{});
  const std::vector<std::byte> empty = test::glb_bytes(scene, "empty_preview");
  EXPECT_EQ(size_of(empty), 0u);
  EXPECT_FALSE(preview_of(empty));
}

// -- Files that are wrong -------------------------------------------------------------------------

TEST(GlbPreviewFile, RefusesWhatIsWrongAlready) {
  RandomScene random(7);
  Scene scene = random.scene();
  TriangleSoup lattice = random.geometry(5, true);
  lattice.appearance = random.lattice_texture(5, 2, false);
  only_soup(scene) = std::move(lattice);
  const std::vector<std::byte> bytes = test::glb_bytes(scene, "wrong_preview");
  const auto refusal = [](Bytes damaged) {
    // The last byte is missing: the file is still arriving.
    return error_of([&] { preview_of(damaged.first(damaged.size() - 1)); });
  };
  const auto expect_refused_json = [&](const std::function<void(nlohmann::json&)>& change,
                                       const auto&... values) {
    auto json = test::glb_json(bytes);
    change(json);
    EXPECT_THAT(refusal(test::with_glb_json(bytes, json)), ErrorIn("arriving.glb", values...));
  };
  const auto expect_refused_word = [&](std::size_t offset, std::uint32_t value,
                                       const auto&... values) {
    std::vector<std::byte> damaged(bytes);
    std::memcpy(&damaged[offset], &value, 4);
    EXPECT_THAT(refusal(damaged), ErrorIn("arriving.glb", values...));
  };
  const char* x = tureen_extension;
  const auto color = [](nlohmann::json& j) -> nlohmann::json& {
    const std::size_t index = j["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"];
    return j["accessors"][index];
  };
  const auto triangles = [&](nlohmann::json& j) -> nlohmann::json& {
    const std::size_t index = j["extensions"][x]["triangles"];
    return j["accessors"][index];
  };
  for (const int version : {0, 2, 6})
    expect_refused_json([&](auto& j) { j["extensions"][x]["version"] = version; }, version, 3, 4,
                        5);
  expect_refused_json([&](auto& j) { color(j)["count"] = 14; }, "COLOR_0", 14, 15);
  expect_refused_json([&](auto& j) { color(j)["componentType"] = 5126; }, 5123);
  expect_refused_json([&](auto& j) { color(j)["count"] = 4000000000u; }, "4000000000", 8);
  expect_refused_json([&](auto& j) { j["extensions"][x]["face_count"] = 1u << 30; }, 15,
                      "3221225472");
  expect_refused_json(
      [&](auto& j) {
        // The bytes of colours as indices name missing vertices.
        triangles(j)["bufferView"] = color(j)["bufferView"];
      },
      "extensions.TUREEN_triangle_soup");
  expect_refused_word(4, 3, 3);
  expect_refused_word(8, 40, 40);
  expect_refused_word(12, 0xfffffff0u, "4294967280");
  expect_refused_word(16, 0);

  // A file too short for a chunk is an error even before the chunk arrives.
  std::vector<std::byte> header(bytes.begin(), bytes.begin() + 16);
  const std::uint32_t length = 16;
  std::memcpy(&header[8], &length, 4);
  EXPECT_EQ(size_of(Bytes(header).first(14)), std::nullopt);
  EXPECT_THROW(size_of(header), InputError);
}

TEST(GlbPreviewFile, DoesNotLookAtWhatHasNotArrived) {
  RandomScene random(8);
  TriangleSoup soup = random.geometry(5, false);
  soup.appearance = random.lattice_texture(5, 2, false);
  const Scene scene = scene_of(std::move(soup));
  std::vector<std::byte> bytes = test::glb_bytes(scene, "texels_preview");
  const std::size_t size = std::size_t(size_of(bytes).value());
  std::fill(bytes.begin() + std::ptrdiff_t(size), bytes.end(), std::byte(0));
  EXPECT_TRUE(preview_of(bytes));
}

}  // namespace tureen_glb_preview_test
}  // namespace tureen
