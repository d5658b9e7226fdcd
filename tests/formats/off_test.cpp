#include "formats/mesh/off.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <random>
#include <string>

#include "formats/common/format_remarks.hpp"
#include "formats/mesh/mesh_remarks.hpp"
#include "scene/spherical_harmonics.hpp"
#include "tests/formats/format_testing.hpp"
#include "tests/formats/truncation.hpp"

namespace tureen {
namespace off_test {

using namespace test;
using ::testing::Contains;
using ::testing::ElementsAre;

const std::string data_folder = std::string(TUREEN_SOURCE_DIR) + "/../shared/data/";

Scene read_text(const std::string& text) {
  Input input = input_of(text, "folder/plant.off");
  return read_off(input);
}

std::optional<Refusal> message_of(const std::string& text) {
  return error_of([&] { read_text(text); });
}

const std::string triangle = "0 0 0\n1 0 0\n0 1 0\n";

TEST(Off, ReadsTriangleSplattingsCoff) {
  const Scene scene =
      read_text("COFF\n3 1 0\n-0.37933099269866943 0 1\n1 0 0\n0 1 0\n3 0 1 2 127 139 60 255\n");
  const TriangleSoup& soup = only_soup(scene);
  EXPECT_THAT(soup.positions, ElementsAre(glm::vec3(-0.37933099269866943f, 0, 1),
                                          glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)));
  EXPECT_THAT(soup.triangles, ElementsAre(glm::uvec3(0, 1, 2)));
  EXPECT_THAT(face_rgba(scene),
              ElementsAre(glm::vec4(127 / 255.0f, 139 / 255.0f, 60 / 255.0f, 1.0f)));
  EXPECT_EQ(scene.info.name, "plant");
  EXPECT_EQ(scene.info.up, glm::vec3(0, 0, 1));
  EXPECT_THAT(scene.info.remarks,
              ElementsAre(Remark{&remarks::up_unknown_to_format, {{"format", "OFF"}}}));
}

TEST(Off, ReadsHeadersOfAllKinds) {
  for (const std::string header :
       {"OFF\n3 1 0\n", "OFF 3 1 0\n", "OFF3 1\n",
        "# note\n\n \tOFF # word\r\n\r\n3\n1 2 # counts\n", "OFF\r3 1 3\r"})
    EXPECT_EQ(only_soup(read_text(header + triangle + "3 0 1 2\n")).triangles.size(), 1u) << header;
}

TEST(Off, FansPolygonsAndCopiesTheirColour) {
  const Scene scene = read_text(
      "OFF 5 3 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 2 0\n"
      "4 0 1 2 3 0.25 0.5 0.75\n2 0 1\n5 4 3 2 1 0 1.0 0.0 0.0 0.5");
  EXPECT_THAT(only_soup(scene).triangles,
              ElementsAre(glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3), glm::uvec3(4, 3, 2),
                          glm::uvec3(4, 2, 1), glm::uvec3(4, 1, 0)));
  const glm::vec4 a(0.25f, 0.5f, 0.75f, 1.0f), b(1, 0, 0, 0.5f);
  EXPECT_THAT(face_rgba(scene), ElementsAre(a, a, b, b, b));
  EXPECT_THAT(scene.info.remarks, Contains(Remark{&remarks::polygons_split, {{"polygons", 2}}}));
  EXPECT_THAT(scene.info.remarks, Contains(Remark{&remarks::small_faces_dropped, {{"faces", 1}}}));
}

TEST(Off, DrawsUncolouredFacesGrey) {
  const Scene some = read_text("OFF 3 3 0\n" + triangle + "3 0 1 2\n3 0 1 2 255 0 0\n3 2 1 0 7\n");
  const glm::vec4 grey(0.8f, 0.8f, 0.8f, 1.0f);
  EXPECT_THAT(face_rgba(some), ElementsAre(grey, glm::vec4(1, 0, 0, 1), grey));
  EXPECT_THAT(some.info.remarks,
              Contains(Remark{&remarks::face_colors_missing, {{"triangles", 2}}}));
  EXPECT_THAT(some.info.remarks, Contains(Remark{&remarks::face_colors_mapped, {{"faces", 1}}}));
  const Scene none = read_text("OFF 3 1 0\n" + triangle + "3 0 1 2\n");
  EXPECT_THAT(face_rgba(none), ElementsAre(grey));
  EXPECT_THAT(none.info.remarks, Contains(Remark{&remarks::colors_missing}));
}

TEST(Off, ReadsVertexColours) {
  const Scene bytes =
      read_text("COFF 3 1 0\n0 0 0 255 0 51 255\n1 0 0 0 0 0 0\n0 1 0 1 1 1 1\n3 0 1 2 1 2 3\n");
  EXPECT_THAT(vertex_rgba(bytes),
              ElementsAre(glm::vec4(1, 0, 51 / 255.0f, 1), glm::vec4(0), glm::vec4(1 / 255.0f)));
  EXPECT_THAT(bytes.info.remarks, Contains(Remark{&remarks::face_colors_dropped}));
  const Scene floats = read_text("OFF 3 1 0\n0 0 0 1 0 0\n1 0 0 0.5 0 0\n0 1 0 1 1 1\n3 0 1 2\n");
  EXPECT_THAT(vertex_rgba(floats),
              ElementsAre(glm::vec4(1, 0, 0, 1), glm::vec4(0.5f, 0, 0, 1), glm::vec4(1)));
}

TEST(Off, TellsBytesFromFloatsOverTheWholeFile) {
  const auto colors = [](const std::string& first, const std::string& second) {
    return face_rgba(
        read_text("OFF 4 2 0\n" + triangle + "1 1 0\n4 0 1 3 2 " + first + "\n3 0 1 2 " + second));
  };
  const glm::vec4 dark(1 / 255.0f, 0, 0, 1), red(1, 0, 0, 1);
  EXPECT_THAT(colors("1 0 0", "2 0 0"), ElementsAre(dark, dark, glm::vec4(2 / 255.0f, 0, 0, 1)));
  EXPECT_THAT(colors("1 0 0", "0.5 0 0"), ElementsAre(red, red, glm::vec4(0.5f, 0, 0, 1)));
  EXPECT_THAT(colors("1 0 0", "0 0 0"), ElementsAre(red, red, glm::vec4(0, 0, 0, 1)));
  EXPECT_THAT(colors("1 0 0 1", "0 0 0 0"), ElementsAre(red, red, glm::vec4(0)));
}

TEST(Off, ClampsFloatColoursWithARemark) {
  const Scene scene = read_text("OFF 3 1 0\n" + triangle + "3 0 1 2 1.5 -0.5 nan");
  EXPECT_THAT(face_rgba(scene), ElementsAre(glm::vec4(1, 0, 0, 1)));
  EXPECT_THAT(scene.info.remarks,
              Contains(Remark{&remarks::color_components_clamped, {{"components", 3}}}));
}

TEST(Off, KeepsPositionsThatAreNotFinite) {
  const Scene scene = read_text("OFF 3 1 0\nnan 0 0\n-inf 1e99 0\n0 0 0\n3 0 1 2\n");
  EXPECT_TRUE(std::isnan(only_soup(scene).positions[0].x));
  EXPECT_EQ(only_soup(scene).positions[1], glm::vec3(-INFINITY, INFINITY, 0));
}

// Row X5 of the catalogue of numerical hazards.
TEST(Off, X5_CommentsMissingAlphaAndColoursFromZeroToOneAreRead) {
  const glm::vec4 grey(0.8f, 0.8f, 0.8f, 1.0f);
  // Comments: whole lines and ends of lines, before, between and after everything.
  const std::string commented =
      "# by hand\nCOFF # kind\n# counts\n 3 1 0 # of them\n\n# corners\n0 0 0 # first\n# 1 1 1\n"
      "1 0 0\n0 1 0#last\n#\n3 0 1 2 # no colour\n# end\n";
  const Scene scene = read_text(commented);
  EXPECT_THAT(only_soup(scene).positions,
              ElementsAre(glm::vec3(0, 0, 0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)));
  EXPECT_THAT(only_soup(scene).triangles, ElementsAre(glm::uvec3(0, 1, 2)));
  EXPECT_THAT(face_rgba(scene), ElementsAre(grey));
  // Colours of faces and of vertices, without and with alpha, as bytes and from 0 to 1.
  const auto of_face = [](const std::string& color) {
    return face_rgba(read_text("OFF 3 1 0\n" + triangle + "3 0 1 2 " + color + "\n")).front();
  };
  EXPECT_EQ(of_face("255 51 0"), glm::vec4(1, 0.2f, 0, 1));
  EXPECT_EQ(of_face("255 51 0 102"), glm::vec4(1, 0.2f, 0, 0.4f));
  EXPECT_EQ(of_face("1.0 0.5 0.25"), glm::vec4(1, 0.5f, 0.25f, 1));
  EXPECT_EQ(of_face("1.0 0.5 0.25 0.125"), glm::vec4(1, 0.5f, 0.25f, 0.125f));
  const auto of_vertex = [](const std::string& color) {
    return vertex_rgba(read_text("COFF 3 1 0\n0 0 0 " + color + "\n1 0 0 " + color + "\n0 1 0 " +
                                 color + "\n3 0 1 2\n"))
        .front();
  };
  EXPECT_EQ(of_vertex("255 51 0"), glm::vec4(1, 0.2f, 0, 1));
  EXPECT_EQ(of_vertex("255 51 0 102"), glm::vec4(1, 0.2f, 0, 0.4f));
  EXPECT_EQ(of_vertex("1.0 0.5 0.25"), glm::vec4(1, 0.5f, 0.25f, 1));
  EXPECT_EQ(of_vertex("1.0 0.5 0.25 0.125"), glm::vec4(1, 0.5f, 0.25f, 0.125f));
}

TEST(Off, RemarksOnTrailingText) {
  const Scene scene = read_text("OFF 3 1 0\n" + triangle + "3 0 1 2\n# fine\n\nmore\n");
  EXPECT_THAT(scene.info.remarks, Contains(Remark{&remarks::text_ignored, {{"line", 8}}}));
}

TEST(Off, RefusesByNameAndPlace) {
  EXPECT_THAT(message_of(""), ErrorAt("plant.off:1"));
  EXPECT_THAT(message_of("PLY\n"), ErrorAt("plant.off:1"));
  EXPECT_THAT(message_of("OFFSET 1"), ErrorAt("plant.off:1", "SET"));
  EXPECT_THAT(message_of("NOFF\n"), ErrorAt("plant.off:1", "NOFF"));
  EXPECT_THAT(message_of("STCNOFF 1"), ErrorAt("plant.off:1", "STCNOFF"));
  EXPECT_THAT(message_of("4OFF 1"), ErrorAt("plant.off:1", "4OFF"));
  EXPECT_THAT(message_of("nOFF 1"), ErrorAt("plant.off:1"));
  EXPECT_THAT(message_of(std::string("OFF BINARY\n\0\0\0\1", 15)), ErrorAt("plant.off:1"));
  EXPECT_THAT(message_of("OFF\n"), ErrorAt("plant.off:2"));
  EXPECT_THAT(message_of("OFF\n-1 0 0"), ErrorAt("plant.off:2", -1, "4294967295"));
  EXPECT_THAT(message_of("OFF\n4000000000 1 0\n"), ErrorAt("plant.off:2", "4000000000", 1));
  EXPECT_THAT(message_of("OFF 3 1 0 9\n" + triangle + "3 0 1 2"), ErrorAt("plant.off:1", 9));
  EXPECT_THAT(message_of("OFF 3 1 0\n0 0 0\n1 0\n0 1 0 0 0\n3 0 1 2"), ErrorAt("plant.off:3"));
  EXPECT_THAT(message_of("OFF 3 1 0\n0 0 0 0\n1 0 0\n0 1 0\n3 0 1 2"), ErrorAt("plant.off:2", 4));
  EXPECT_THAT(message_of("OFF 3 1 0\n0 0 0\n1 0 0 9\n0 1 0\n3 0 1 2"), ErrorAt("plant.off:3", 4));
  EXPECT_THAT(message_of("OFF 3 1 0\n" + triangle + "3 0 1 3\n"), ErrorAt("plant.off:5", 0, 3));
  EXPECT_THAT(message_of("OFF 3 1 0\n" + triangle + "3 0 -1 2\n"),
              ErrorAt("plant.off:5", 0, -1, 3));
  EXPECT_THAT(message_of("OFF 3 1 0\n" + triangle + "3 0 1\n"), ErrorAt("plant.off:5"));
  EXPECT_THAT(message_of("OFF 3 1 0\n" + triangle + "-3 0 1 2\n"),
              ErrorAt("plant.off:5", -3, "4294967295"));
  EXPECT_THAT(message_of("OFF 3 1 0\n" + triangle + "3 0 1 2 1 1\n"), ErrorAt("plant.off:5", 2));
  EXPECT_THAT(message_of("OFF 3 1 0\n" + triangle + "3 0 1 2 300 1 1\n"),
              ErrorAt("plant.off:5", 300, 255));
  EXPECT_THAT(message_of("OFF 3 2 0\n" + triangle + "3 0 1 2 3\n"), ErrorAt("plant.off:6", 1, 2));
}

TEST(Off, SurvivesTruncationAndDamage) {
  const std::string text =
      "COFF # c\n4 2 0\n0 0.5 0 1 2 3 255\n1 0 -1e3 1 2 3 4\n0 1 0 5 6 7 8\n9 9 9 1 1 1 1\n"
      "3 0 1 2 0.5 1 1\n4 0 1 2 3 1 0 0 1\n";
  const auto read = [](std::span<const std::byte> bytes) {
    Input input = Input::memory("damaged.off", bytes);
    const Scene scene = read_off(input);
    EXPECT_EQ(defect(only_soup(scene)), std::nullopt);
  };
  const auto bytes = std::as_bytes(std::span(text));
  // If the last colour is cut anywhere, the rest may still be a colour or no colour.
  const Survival cut = survive_truncation(bytes, read);
  EXPECT_GE(cut.refused, bytes.size() - 9);
  const Survival damaged = survive_damage(bytes, read);
  EXPECT_GT(damaged.refused, 0u);
  EXPECT_GT(damaged.read, 0u);
}

TEST(Off, RoundTripsBitForBit_seed5) {
  std::mt19937 random(5);
  const auto uniform = [&] { return float(random()) / 4294967296.0f; };
  for (const bool by_vertex : {false, true}) {
    TriangleSoup soup;
    for (int i = 0; i < 300; ++i)
      soup.positions.emplace_back(uniform() - 0.5f, uniform() * 1e-30f, (uniform() - 0.5f) * 1e20f);
    for (std::uint32_t t = 0; t < 100; ++t) soup.triangles.emplace_back(3 * t, random() % 300, 2);
    std::vector<glm::vec4> rgba;
    for (int i = 0; i < (by_vertex ? 300 : 100); ++i) {
      glm::vec4 color;
      for (int c = 0; c < 4; ++c) color[c] = float(random() % 256) / 255.0f;
      if (i % 2) color.a = 1.0f;
      rgba.push_back(color);
    }
    if (by_vertex)
      soup.appearance = VertexColors{rgba};
    else
      soup.appearance = FaceColors{rgba};
    Scene scene = scene_of(soup);
    scene.info.up = {0, 0, 1};
    TemporaryFolder folder;
    EXPECT_THAT(write_off(scene, folder / "a.off"), ElementsAre());
    const Scene again = read_off(folder / "a.off");
    EXPECT_EQ(only_soup(again).positions, soup.positions);
    EXPECT_EQ(only_soup(again).triangles, soup.triangles);
    EXPECT_EQ(by_vertex ? vertex_rgba(again) : face_rgba(again), rgba);
  }
}

TEST(Off, SaysWhatWritingLosesInEnglish) {
  TriangleSoup soup;
  soup.positions.resize(3);
  soup.triangles.emplace_back(0, 1, 2);
  soup.appearance = FaceColors{{glm::vec4(0.5f, 0, 0, 0.5f)}};
  Scene scene = scene_of(soup, {1, 0, 0});
  scene.info.background = glm::vec3(1);
  scene.cameras.resize(1);
  scene.first_view = scene.cameras[0];
  TemporaryFolder folder;
  EXPECT_THAT(
      write_off(scene, folder / "a.off"),
      ElementsAre("OFF stores no up axis: readers assume z, but that of the scene is y, so they "
                  "show it tilted.",
                  "OFF holds no background colour.", "OFF holds no cameras.",
                  "OFF holds no first view.", "OFF holds colours in 8 bits: they are rounded."));
  // Rounding is half up, so an alpha of one half stays visible.
  EXPECT_THAT(face_rgba(read_off(folder / "a.off")),
              ElementsAre(glm::vec4(128 / 255.0f, 0, 0, 128 / 255.0f)));
}

TEST(Off, AppliesTheTransformOfALayerToItsPositions) {
  TriangleSoup soup;
  soup.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  soup.triangles.emplace_back(0, 1, 2);
  soup.appearance = FaceColors{{glm::vec4(1)}};
  Scene scene = scene_of(soup, {1, 0, 0});
  scene.info.up = {0, 0, 1};
  // Twice as large, mirrored in x, y and z exchanged: a rotation and two mirrors.
  scene.layers[0].world_from_layer[0] = {-2, 0, 0, 0};
  scene.layers[0].world_from_layer[1] = {0, 0, 2, 0};
  scene.layers[0].world_from_layer[2] = {0, 2, 0, 0};
  const TemporaryFolder folder;
  EXPECT_THAT(write_off(scene, folder / "a.off"), ElementsAre(Names("OFF", "transform")));
  Scene again = read_off(folder / "a.off");
  EXPECT_THAT(only_soup(again).positions,
              ElementsAre(glm::vec3(1, 0, 0), glm::vec3(-1, 0, 0), glm::vec3(1, 0, 2)));
  EXPECT_THAT(only_soup(again).triangles, ElementsAre(glm::uvec3(0, 1, 2)));

  // A mirror alone exchanges two corners, so that the same side faces outwards.
  scene.layers[0].world_from_layer = glm::dmat4(-1.0);
  scene.layers[0].world_from_layer[3] = {0, 0, 0, 1};
  write_off(scene, folder / "b.off");
  again = read_off(folder / "b.off");
  EXPECT_EQ(only_soup(again).positions[1], glm::vec3(-1, 0, 0));
  EXPECT_THAT(only_soup(again).triangles, ElementsAre(glm::uvec3(0, 2, 1)));
  // The scene itself is unchanged.
  EXPECT_EQ(only_soup(scene).positions, soup.positions);

  // Far away, floats are 4 units apart: the error is reported.
  scene.layers[0].world_from_layer = at_origin({5e7, 0, 0});
  EXPECT_THAT(write_off(scene, folder / "far.off"),
              ElementsAre("OFF holds positions with 24 bits: in world coordinates they are rounded "
                          "by up to 1 units."));
  EXPECT_EQ(only_soup(read_off(folder / "far.off")).positions[0], glm::vec3(5e7f, 0, 0));

  scene.layers.resize(2);
  EXPECT_THROW(write_off(scene, folder / "c.off"), UsageError);
  EXPECT_FALSE(std::filesystem::exists(folder / "c.off"));
}

TEST(Off, WritesMeanColoursOfOtherAppearances) {
  // Harmonics of degree 0 have the same colour in every direction: 1/2 + Y_00 c.
  TriangleSoup soup;
  soup.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  soup.triangles.emplace_back(0, 1, 2);
  const auto c = float(0.1 / harmonics::y00);
  soup.appearance = Harmonics{.degree = 0, .coefficients = {glm::vec3(c, 0.0f, -c)}};
  Scene scene = scene_of(soup);
  scene.info.up = {0, 0, 1};
  const TemporaryFolder folder;
  EXPECT_THAT(write_off(scene, folder / "a.off"),
              ElementsAre(Names("OFF", appearance_name(soup.appearance)), Names("OFF", 8)));
  const Scene again = read_off(folder / "a.off");
  EXPECT_EQ(only_soup(again).positions, soup.positions);
  EXPECT_THAT(face_rgba(again), ElementsAre(glm::vec4(153, 128, 102, 255) / 255.0f));

  only_layer(scene).primitives = Splats{
      .kernel = TriangleWindows{.corners = soup.positions, .sigma = {1.0f}, .opacity = {0.9f}},
      .color = {.coefficients = {glm::vec3(c, 0.0f, -c)}}};
  EXPECT_THAT(write_off(scene, folder / "b.off"),
              Contains(Names("OFF", appearance_name(soup.appearance))));
  EXPECT_EQ(face_rgba(read_off(folder / "b.off")), face_rgba(again));
}

TEST(Off, ReportsProgress) {
  std::string text = "OFF 200000 0 0\n";
  for (int i = 0; i < 200000; ++i) text += "0 0 0\n";
  std::vector<double> fractions;
  ReadOptions options;
  options.progress = [&](double fraction) { fractions.push_back(fraction); };
  Input input = input_of(text);
  read_off(input, options);
  ASSERT_EQ(fractions.size(), 3u);
  EXPECT_NEAR(fractions[1], 131072.0 / 200000.0, 0.001);
}

TEST(Off, ReadsTheRealFicus) {
  const std::string path = data_folder + "soups/ficus_2dts.off";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " does not exist";
  const Scene scene = read_off(path);
  EXPECT_EQ(only_soup(scene).triangles.size(), 33417u);
  EXPECT_EQ(only_soup(scene).positions.size(), 100251u);
  EXPECT_EQ(face_rgba(scene).front(), glm::vec4(162 / 255.0f, 155 / 255.0f, 127 / 255.0f, 1));
  EXPECT_THAT(scene.info.remarks,
              ElementsAre(Remark{&remarks::up_unknown_to_format, {{"format", "OFF"}}}));
}

TEST(Off, HostileFilesEndWell) {
  const std::string folder = data_folder + "hostile/off/";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " does not exist";
  EXPECT_THAT(error_of([&] { read_off(folder + "empty.off"); }), ErrorAt(folder + "empty.off:1"));
  EXPECT_THAT(error_of([&] { read_off(folder + "invalid.off"); }),
              ErrorAt(folder + "invalid.off:7"));
  const Scene scene = read_off(folder + "whitespace.off");
  EXPECT_EQ(only_soup(scene).triangles.size(), 12u);
  EXPECT_EQ(face_rgba(scene)[3], glm::vec4(0.3f, 0.4f, 0.0f, 0.75f));
}

}  // namespace off_test
}  // namespace tureen
