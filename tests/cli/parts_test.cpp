// Parts of the program that are libraries.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <glm/geometric.hpp>

#include "base/decimal_text.hpp"
#include "base/error.hpp"
#include "base/suggestion.hpp"
#include "cli/files/image_file.hpp"
#include "cli/options/material_option.hpp"
#include "cli/options/values.hpp"
#include "cli/options/view_options.hpp"
#include "cli/progress.hpp"
#include "cli/report.hpp"
#include "cli/version.hpp"
#include "image/contact_sheet.hpp"

namespace tureen::cli {
namespace parts_test {

using testing::HasSubstr;

TEST(Suggestion, CountsEditsAndSwaps) {
  EXPECT_EQ(edit_distance("", "abc"), 3);
  EXPECT_EQ(edit_distance("render", "render"), 0);
  EXPECT_EQ(edit_distance("rendr", "render"), 1);
  EXPECT_EQ(edit_distance("redner", "render"), 1);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
}

TEST(Suggestion, NamesTheNearestAndNothingThatIsFar) {
  const std::vector<std::string> known{"render", "info", "convert", "compare"};
  EXPECT_EQ(nearest("covnert", known), "convert");
  EXPECT_EQ(nearest("inf", known), "info");
  EXPECT_EQ(nearest("comp", known), "compare");  // a prefix
  EXPECT_EQ(nearest("tradeoff", known), "");
  EXPECT_EQ(nearest("", known), "");
  // The case of letters is ignored, but decides between names that differ in nothing else.
  EXPECT_EQ(nearest("RENDER", known), "render");
  EXPECT_EQ(nearest("COVNERT", known), "convert");
  EXPECT_EQ(nearest("COMP", known), "compare");
  EXPECT_EQ(nearest("Scene.GLP", std::vector<std::string>{"scene.glb", "Scene.GLB"}), "Scene.GLB");
}

TEST(MaterialOption, ReadsLayerMaterialAndIndex) {
  const auto parsed = [](const std::string& text) { return parse_material_choice(text); };
  EXPECT_EQ(parsed("ball=mirror").layer, "ball");
  EXPECT_EQ(parsed("ball=mirror").material, mirror_material());
  EXPECT_EQ(parsed("a = b=glass").layer, "a = b") << "the last = separates";
  EXPECT_EQ(parsed("ball=glass").material, glass_material(1.5f));
  EXPECT_EQ(parsed("layer 2=glass:1.33").material, glass_material(1.33f));
  EXPECT_EQ(parsed("ball=glass:1").material, glass_material(1));
  EXPECT_EQ(parsed("ball=stored").material, std::nullopt);
  for (const char* bad :
       {"", "ball", "=mirror", "ball=", "ball=gold", "ball=glass:", "ball=glass:x",
        "ball=glass:0.9", "ball=glass:nan", "ball=glass:inf", "ball=mirror:1"})
    EXPECT_THROW(parsed(bad), UsageError) << bad;
}

TEST(MaterialOption, AppliesToMeshesByTheirLabels) {
  Scene scene = scene_of(TriangleSoup{});
  scene.layers[0].material = glass_material(2);
  scene.layers.push_back({.name = "ball"});
  scene.layers.push_back({.name = "fox", .primitives = Splats{}});
  apply_materials({{"ball", mirror_material()}, {"layer 1", mirror_material()}, {"layer 1", {}}},
                  scene);
  EXPECT_EQ(scene.layers[0].material, glass_material(2)) << "as stored";
  EXPECT_EQ(scene.layers[1].material, mirror_material());
  const auto message = [&](const MaterialChoice& choice) -> std::string {
    try {
      apply_materials({choice}, scene);
    } catch (const UsageError& error) {
      return error.reason();
    }
    return "";
  };
  EXPECT_THAT(message({"wall", mirror_material()}), HasSubstr("layer 1, ball, fox"));
  EXPECT_THAT(message({"fox", mirror_material()}), HasSubstr("has splats"));
}

TEST(Values, ReadWhatIsMeantAndRefuseTheRest) {
  EXPECT_EQ(parse_size("1280x720").width, 1280);
  EXPECT_EQ(parse_size("1280x720").height, 720);
  for (const char* bad : {"", "x", "12", "12x", "x12", "0x1", "-1x5", "1x1x1", "1e3x5", "99999x1"})
    EXPECT_THROW(parse_size(bad), UsageError) << bad;
  EXPECT_THROW(parse_size("65536x65536"), UsageError);
  EXPECT_EQ(parse_any_size("65536x65536").height, 65536);
  EXPECT_THROW(parse_any_size("65537x1"), UsageError);
  EXPECT_EQ(parse_vector("1,-2.5,3e2"), glm::dvec3(1, -2.5, 300));
  for (const char* bad : {"", "1,2", "1,2,3,4", "1,2,x", "1,2,nan", "1,2,inf", "1 2 3", "1,2,3 "})
    EXPECT_THROW(parse_vector(bad), UsageError) << bad;
  EXPECT_EQ(parse_background("white"), glm::vec4(1));
  EXPECT_EQ(parse_background("transparent"), glm::vec4(0));
  EXPECT_EQ(parse_background("0,0.5,1"), glm::vec4(0, 0.5f, 1, 1));
  EXPECT_THROW(parse_background("0,0.5,1.5"), UsageError);
}

TEST(ImageName, NumbersSeveralImages) {
  EXPECT_EQ(image_name("a/out.png", 0, 1), "a/out.png");
  EXPECT_EQ(image_name("a/out.png", 3, 8), "a/out_03.png");
  EXPECT_EQ(image_name("out.png", 7, 1000), "out_007.png");
  EXPECT_EQ(image_name("v%d.png", 12, 20), "v12.png");
  EXPECT_EQ(image_name("v%03d.png", 12, 20), "v012.png");
  EXPECT_EQ(image_name("v%03d.png", 0, 1), "v000.png");
  EXPECT_EQ(image_name("100%%.png", 0, 1), "100%.png");
  for (const char* bad : {"%s.png", "%", "%n.png", "%d%d.png", "%100d.png", "%-3d.png"})
    EXPECT_THROW(image_name(bad, 0, 2), UsageError) << bad;
}

TEST(Report, WritesNumbersForPeople) {
  EXPECT_EQ(counted(7), "7");
  EXPECT_EQ(counted(33417), "33,417");
  EXPECT_EQ(counted(1234567890), "1,234,567,890");
  EXPECT_EQ(bytes_text(917), "917 bytes");
  EXPECT_EQ(bytes_text(1536), "1.5 KiB");
  EXPECT_EQ(bytes_text(34u << 20), "34 MiB");
}

/// The text that a Progress writes to a stream, with a simulated clock.
std::string progress_text(bool terminal, const std::vector<std::pair<double, double>>& updates,
                          const std::string& detail = {}) {
  std::FILE* stream = std::tmpfile();
  double now = 0;
  {
    Progress progress("working", {stream, terminal, [&] { return now; }});
    for (const auto& [time, fraction] : updates) {
      now = time;
      progress.update(fraction, detail);
    }
  }
  std::string text(std::size_t(std::ftell(stream)), '\0');
  std::rewind(stream);
  EXPECT_EQ(std::fread(text.data(), 1, text.size(), stream), text.size());
  std::fclose(stream);
  return text;
}

TEST(Progress, IsSilentWhenWorkIsDoneAtOnce) {
  EXPECT_EQ(progress_text(true, {{0.1, 0.5}, {0.2, 1.0}}), "");
  EXPECT_EQ(progress_text(false, {{1, 0.5}, {4, 1.0}}), "");
}

TEST(Progress, DrawsABarOnATerminalAndWipesIt) {
  const std::string text = progress_text(true, {{1.0, 0.5}, {1.01, 0.6}, {1.2, 2.0}});
  EXPECT_THAT(text, HasSubstr("working [###############...............] 50 %"));
  EXPECT_THAT(text, testing::Not(HasSubstr("60 %")));  // too soon after the last update
  EXPECT_THAT(text, HasSubstr("100 %"));               // never more
  EXPECT_THAT(text, testing::EndsWith("\r\033[K"));
}

TEST(Progress, EstimatesTheTimeThatIsLeft) {
  EXPECT_EQ(time_left_text(0.5, 4), "");
  EXPECT_EQ(time_left_text(0.0, 10), "");
  EXPECT_EQ(time_left_text(0.5, 10), "11 s left");
  EXPECT_EQ(time_left_text(0.1, 60), "10 min left");
}

TEST(Progress, WritesPlainLinesElsewhere) {
  EXPECT_EQ(progress_text(false, {{6, 0.25}, {7, 0.3}, {12, 0.75}}),
            "working: 25 %\nworking: 75 %\n");
}

TEST(Progress, SaysMoreBesideAShorterBar) {
  EXPECT_THAT(progress_text(true, {{1.0, 0.5}}, "7/14, 3 it/s"),
              HasSubstr("working [#####.....] 7/14, 3 it/s\033[K"));
  EXPECT_EQ(progress_text(false, {{6, 0.25}}, "7/28"), "working: 25 %, 7/28\n");
}

TEST(ContactSheet, HoldsEveryImageInAGrid) {
  std::vector<Image8> images;
  for (int i = 0; i < 5; ++i) images.emplace_back(640, 320, glm::u8vec4(10 * i, 0, 0, 255));
  const Image8 sheet = contact_sheet(images);
  // The best grid for five images of 320 x 160 has two columns and three rows.
  EXPECT_EQ(sheet.width, 2 * 328 + 8);
  EXPECT_EQ(sheet.height, 3 * 168 + 8);
  for (int i = 0; i < 5; ++i)
    EXPECT_EQ(sheet.at(8 + (i % 2) * 328, 8 + (i / 2) * 168), images[std::size_t(i)].at(0, 0));
  EXPECT_EQ(sheet.at(0, 0), glm::u8vec4(0));
}

// --- Views ----------------------------------------------------------------------------------

Scene box_scene() {
  TriangleSoup soup;
  soup.positions = {{-1, -1, -1}, {1, 1, 1}, {1, -1, 0}};
  soup.triangles = {{0, 1, 2}};
  soup.appearance = FaceColors{{glm::vec4(1)}};
  Scene scene = scene_of(std::move(soup), {10, 0, 0});
  scene.info.up = {0, 0, 1};
  return scene;
}

TEST(Views, FrameTheSceneUnlessToldOtherwise) {
  const Views views = resolve_views({}, box_scene(), "scene.glb");
  ASSERT_EQ(views.cameras.size(), 1u);
  const Camera& camera = views.cameras[0];
  EXPECT_EQ(camera.width, 1280);
  EXPECT_EQ(camera.height, 720);
  EXPECT_NEAR(2 * std::atan(0.5 * camera.height / camera.fy), 0.698131700797732, 1e-12);  // 40 deg
  // The camera looks at the centre, from the front (-y), the right (+x) and above (+z).
  const glm::dvec3 from = camera.eye() - glm::dvec3(10, 0, 0);
  EXPECT_LT(from.y, 0);
  EXPECT_GT(from.x, 0);
  EXPECT_GT(from.z, 0);
}

TEST(Views, TheScenesOwnCameraComesBeforeAViewOfOurs) {
  Scene scene = box_scene();
  scene.cameras = {look_at({1, 2, 3}, {0, 0, 0}, {0, 0, 1}, 0.5, 200, 100)};
  EXPECT_EQ(resolve_views({}, scene, "").cameras[0].width, 200);
  ViewOptions options;
  options.size = "400x300";
  const Camera larger = resolve_views(options, scene, "").cameras[0];
  EXPECT_EQ(larger.width, 400);
  EXPECT_DOUBLE_EQ(larger.fx, 2 * scene.cameras[0].fx);  // the whole width, and more above it
  options.orbit = 4;
  EXPECT_EQ(resolve_views(options, scene, "").cameras.size(), 4u);
}

TEST(Views, EyeAndTargetAreInTheWorld) {
  ViewOptions options;
  options.eye = "10,-4,0";
  options.fov_degrees = 90;
  options.size = "100x50";
  const Camera camera = resolve_views(options, box_scene(), "").cameras[0];
  EXPECT_LT(glm::length(camera.eye() - glm::dvec3(10, -4, 0)), 1e-12);
  EXPECT_NEAR(camera.fy, 25, 1e-12);  // half the height times cot 45
  // Without a target, the camera looks at the centre of the scene.
  const glm::dvec3 forward = -camera.world_from_view_rotation()[2];
  EXPECT_LT(glm::length(forward - glm::dvec3(0, 1, 0)), 1e-12);
  options.target = options.eye;
  EXPECT_THROW(resolve_views(options, box_scene(), ""), UsageError);
}

TEST(Views, ReadTheFilesOfRealDataSets) {
  const std::string data = std::string(TUREEN_SOURCE_DIR) + "/../shared/data/";
  if (!std::ifstream(data + "photos/fox/transforms.json")) GTEST_SKIP() << "no ../shared/data";
  ViewOptions options;
  options.camera = data + "photos/fox/transforms.json:0";
  const Views fox = resolve_views(options, box_scene(), "");
  EXPECT_EQ(fox.cameras[0].width, 1080);
  EXPECT_NEAR(fox.cameras[0].cx, 554.558, 1e-9);
  EXPECT_LT(glm::length(fox.cameras[0].eye() - glm::dvec3(3.168359, -5.479490, -0.979166)), 1e-5);
  EXPECT_THAT(fox.notes, testing::SizeIs(1));
  options.camera = data + "rendered/lego/transforms_test.json:all";
  const Views lego = resolve_views(options, box_scene(), "");
  EXPECT_EQ(lego.cameras.size(), 25u);
  EXPECT_NEAR(lego.cameras[0].fx, 1111.111, 1e-3);
}

TEST(Version, SaysWhetherThisIsARelease) {
#if defined NDEBUG && !defined __SANITIZE_ADDRESS__ && !defined __SANITIZE_THREAD__
  EXPECT_STREQ(program_build(), "release");
#else
  EXPECT_STRNE(program_build(), "release");
#endif
}

}  // namespace parts_test
}  // namespace tureen::cli
