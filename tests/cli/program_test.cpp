// Program tests: exit codes, messages, and files on the disk.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "formats/dataset/camera_file.hpp"
#include "formats/scene_file.hpp"
#include "image/metrics.hpp"
#include "scene/camera.hpp"
#include "tests/cli/program_fixture.hpp"
#include "tests/support/errors.hpp"

namespace tureen {
namespace program_test {

using test::Names;
namespace fs = std::filesystem;
using test::ChildResult;
using test::Program;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;

// --- Usage ----------------------------------------------------------------------------------

TEST_F(Program, HelpTeachesAndGoesToStandardOutput) {
  for (const char* command : {"render", "info", "convert", "compare", "train", "eval", "report"}) {
    const ChildResult result = run({command, "--help"});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_THAT(result.out, Names(std::string("tureen ") + command));
    EXPECT_THAT(result.err, IsEmpty());
  }
  EXPECT_THAT(run({"--help"}).out, Names("render", "train"));
  EXPECT_THAT(run({"--version"}).out, Names("tureen"));
}

TEST_F(Program, HelpThatCannotBeWrittenIsFive) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  for (const char* words : {"--help", "--version", "render --help"}) {
    const std::string line = "exec \"$0\" " + std::string(words) + " >/dev/full";
    const ChildResult result = test::Child({"-c", line, TUREEN_PROGRAM}, folder, "/bin/sh").wait();
    EXPECT_EQ(result.exit_code, 5) << words;
    EXPECT_THAT(result.err, Not(IsEmpty()));
  }
}

TEST_F(Program, WrongUsageIsTwoAndAHint) {
  const auto expect = [&](const std::vector<std::string>& arguments, const auto&... values) {
    const ChildResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, Names(values...));
    EXPECT_THAT(result.out, IsEmpty());
  };
  write_scene();
  expect({}, "tureen");
  expect({"rendr", "scene.off"}, "rendr", "render");
  expect({"zebra"}, "zebra");
  expect({"render", "scene.off", "--sise", "8x8"}, "--sise", "--size");
  expect({"render"}, "SCENE");
  expect({"compare", "a.png", "b.png", "dataset", "other.png"}, "other.png");
  expect({"compare", "scene.off", "scene.off"}, "DATASET");
  expect({"render", "scene.off", "--size", "80"}, 80, "1280x720");
  expect({"render", "scene.off", "--context", "elg"}, "elg", "--context");
  expect({"render", "scene.off", "--eye", "1,2"}, "1,2");
  expect({"render", "scene.off", "--target", "1,2,3"}, "--target", "--eye");
  expect({"render", "scene.off", "--orbit", "0"}, "--orbit");
  expect({"render", "scene.off", "--background", "pinkish"}, "pinkish");
  expect({"render", "scene.off", "-o", "out.jpg"}, "out.jpg");
  expect({"render", "scene.off", "-o", "out%s.png"}, "out%s.png");
  expect({"compare", "a.png", "b.png", "--metric", "psnr"}, "psnr", "psnr_db");
  expect({"compare", "a.png", "b.png", "--pixel-tolerance", "nan"}, "nan", "--pixel-tolerance");
  expect({"compare", "a.png", "b.png", "--pixel-tolerance", "0x1"}, "0x1", "--pixel-tolerance");
  expect({"bench", "scene.off", "--rounds", "2.5"}, "--rounds", "2.5", 10000);
}

TEST_F(Program, ABadInputIsThreeAndAPlace) {
  const auto expect = [&](const std::vector<std::string>& arguments, const auto&... values) {
    const ChildResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 3);
    EXPECT_THAT(result.err, Names(values...));
    EXPECT_THAT(result.out, IsEmpty());
  };
  write_scene();
  write("broken.off", "COFF\n3 1 0\n0 0 0\n1 0 zero\n0 1 0\n3 0 1 2\n");
  write("cameras.json", "{\"cameras\": []}");
  expect({"info", "scen.off"}, "scen.off", "scene.off");
  expect({"info", "nowhere/scene.off"}, "nowhere/scene.off");
  expect({"info", "broken.off"}, "broken.off:4");
  expect({"render", "broken.off"}, "broken.off:4");
  write("a.png", "no image");
  expect({"compare", "a.png", "a.png"}, "a.png");
  expect({"compare", "a.png", "none.png"}, "a.png");
  expect({"render", "scene.off", "--camera", "cameras.json"}, "cameras.json");
  expect({"render", "scene.off", "--camera", "scene.off"}, "scene.off");
}

// --- compare --------------------------------------------------------------------------------

TEST_F(Program, CompareReportsAndFailsPastItsTolerance) {
  const Image8 grey(32, 24, glm::u8vec4(100, 100, 100, 255));
  Image8 other = grey;
  other.at(5, 5) = glm::u8vec4(151, 100, 100, 255);
  write_png("a.png", grey);
  write_png("b.png", other);
  const ChildResult result = run({"compare", "a.png", "b.png", "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::ordered_json::parse(result.out);
  EXPECT_THAT(keys(json),
              ElementsAre("mae", "mse", "psnr_db", "ssim", "flip", "max_abs", "p999_abs",
                          "coverage_mismatch", "failing_fraction", "ssim_border", "non_finite"));
  EXPECT_NEAR(json["max_abs"].get<double>(), 0.2, 1e-6);
  EXPECT_NEAR(json["failing_fraction"].get<double>(), 1.0 / (32 * 24), 1e-12);
  EXPECT_EQ(json["ssim_border"], "zero_pad");

  EXPECT_EQ(run({"compare", "a.png", "b.png", "--tolerance", "0.01"}).exit_code, 0);
  for (const char* passes_all : {"1e999", "inf", "nan", "-1", "x"})
    EXPECT_EQ(run({"compare", "a.png", "b.png", "--tolerance", passes_all}).exit_code, 2);
  const ChildResult failed =
      run({"compare", "a.png", "b.png", "--tolerance", "0.1", "--metric", "max_abs", "--json"});
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_THAT(failed.err, Names("max_abs", 0.2, 0.1));
  EXPECT_EQ(nlohmann::json::parse(failed.out)["passed"], false);
  // A higher PSNR is better: 43 dB here.
  EXPECT_EQ(
      run({"compare", "a.png", "b.png", "--tolerance", "40", "--metric", "psnr_db"}).exit_code, 0);
  EXPECT_EQ(
      run({"compare", "a.png", "b.png", "--tolerance", "50", "--metric", "psnr_db"}).exit_code, 1);
}

TEST_F(Program, CompareShowsWhereAndRefusesOtherSizes) {
  write_png("a.png", Image8(20, 10, glm::u8vec4(0, 0, 0, 255)));
  Image8 other(20, 10, glm::u8vec4(0, 0, 0, 255));
  other.at(3, 4) = glm::u8vec4(255, 255, 255, 255);
  write_png("b.png", other);
  write_png("c.png", Image8(20, 11));
  EXPECT_EQ(run({"compare", "a.png", "b.png", "--diff", "diff.png"}).exit_code, 0);
  const Image8 diff = read_png("diff.png");
  EXPECT_EQ(diff.width, 60);
  EXPECT_EQ(diff.height, 10);
  EXPECT_EQ(diff.at(20 + 3, 4), glm::u8vec4(255));
  EXPECT_EQ(diff.at(40 + 3, 4), glm::u8vec4(255));           // the hottest colour
  EXPECT_EQ(diff.at(40 + 4, 4), glm::u8vec4(0, 0, 0, 255));  // no difference
  const ChildResult result = run({"compare", "a.png", "c.png"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, Names("20 x 10", "20 x 11"));
}

TEST_F(Program, CompareLooksAtImagesOnTheirBackground) {
  write_png("clear.png", Image8(16, 16, glm::u8vec4(255, 255, 255, 0)));
  write_png("black.png", Image8(16, 16, glm::u8vec4(0, 0, 0, 255)));
  const auto mae = [&](const std::string& background) {
    return nlohmann::json::parse(
        run({"compare", "clear.png", "black.png", "--json", "--background", background})
            .out)["mae"];
  };
  EXPECT_EQ(mae("black"), 0);
  EXPECT_EQ(mae("white"), 1);
}

// --- info -----------------------------------------------------------------------------------

TEST_F(Program, InfoTellsWhatASceneIs) {
  write_scene();
  const ChildResult result = run({"info", "scene.off", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::ordered_json::parse(result.out);
  for (const char* key : {"file", "triangles", "vertices", "appearance", "bytes_on_disk",
                          "bytes_in_memory", "bytes_on_device", "bounds", "up", "cameras", "notes",
                          "remarks", "plan", "specialisations", "devices", "lint"})
    EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_EQ(json["triangles"], 3);
  EXPECT_EQ(json["appearance"], "face colours");
  EXPECT_EQ(json["bytes_on_disk"], fs::file_size(folder / "scene.off"));
  EXPECT_EQ(json["bounds"]["high"], nlohmann::ordered_json({1.0, 1.0, 1.0}));
  EXPECT_EQ(json["lint"]["duplicate_faces"]["count"], 1);
  EXPECT_EQ(json["lint"]["duplicate_faces"]["first"], nlohmann::ordered_json({2}));
  EXPECT_FALSE(json["plan"].empty());
  const nlohmann::ordered_json repeated{
      {"name", "coincident-faces"}, {"count", 1}, {"total", 3}, {"margin", 0.0}};
  EXPECT_EQ(json["specialisations"][0], repeated);
  EXPECT_TRUE(json["devices"][0]["fits"].get<bool>());
  EXPECT_THAT(result.err, Names("1 of 3", 2));
}

TEST_F(Program, InfoIsStrictOnRequest) {
  write_scene();
  EXPECT_EQ(run({"info", "scene.off", "--strict"}).exit_code, 1);
  write("clean.off", "COFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 255 0 0\n");
  const ChildResult result = run({"info", "clean.off", "--strict"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

// --- convert --------------------------------------------------------------------------------

TEST_F(Program, ConvertNeverOverwritesSilently) {
  write_scene();
  const ChildResult first = run({"convert", "scene.off", "scene.ply", "--json"});
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_THAT(keys(nlohmann::ordered_json::parse(first.out)),
              ElementsAre("output", "bytes_on_disk", "notes", "remarks", "lost"));
  write("scene.ply", "precious");
  const ChildResult second = run({"convert", "scene.off", "scene.ply"});
  EXPECT_EQ(second.exit_code, 2);
  EXPECT_THAT(second.err, Names("scene.ply", "--force"));
  EXPECT_EQ(fs::file_size(folder / "scene.ply"), 8u);
  EXPECT_EQ(run({"convert", "scene.off", "scene.ply", "--force"}).exit_code, 0);
  EXPECT_GT(fs::file_size(folder / "scene.ply"), 8u);
  const ChildResult itself = run({"convert", "scene.off", "scene.off", "--force"});
  EXPECT_EQ(itself.exit_code, 2);
  EXPECT_THAT(itself.err, Names("scene.off"));
  const ChildResult unknown = run({"convert", "scene.off", "scene.xyz"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, Names(".xyz"));
  EXPECT_FALSE(exists("scene.xyz"));
}

// --- render ---------------------------------------------------------------------------------

TEST_F(Program, RenderDrawsAndReports) {
  write_scene();
  const ChildResult result =
      run({"render", "scene.off", "-o", "picture.png", "--size", "64x48", "--eye", "0,-5,0",
           "--target", "0,0,0", "--frames", "5", "--context", "osmesa", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::ordered_json::parse(result.out);
  EXPECT_THAT(keys(json),
              ElementsAre("width", "height", "context", "renderer", "software", "triangles",
                          "splats", "frame_ms", "plan", "specialisations", "output"));
  EXPECT_EQ(json["width"], 64);
  EXPECT_EQ(json["height"], 48);
  EXPECT_EQ(json["triangles"], 3);
  EXPECT_EQ(json["frame_ms"]["n"], 5);
  EXPECT_GT(json["frame_ms"]["median"].get<double>(), 0);
  EXPECT_GE(json["frame_ms"]["p95"].get<double>(), json["frame_ms"]["median"].get<double>());
  EXPECT_EQ(json["output"], nlohmann::ordered_json({"picture.png"}));
  const Image8 image = read_png("picture.png");
  EXPECT_EQ(image.width, 64);
  EXPECT_EQ(image.height, 48);
  // From the front, the red triangle hides the green one. The corners show the background.
  EXPECT_EQ(image.at(32, 24), glm::u8vec4(255, 0, 0, 255));
  EXPECT_EQ(image.at(0, 0), glm::u8vec4(0, 0, 0, 255));
  EXPECT_THAT(result.err, Names("picture.png"));
}

TEST_F(Program, RenderNeedsNoOpenGlWithTheOracle) {
  write_scene();
  const std::vector<std::string> view = {"render", "scene.off", "--size",   "64x48",
                                         "--eye",  "0,-5,0",    "--target", "0,0,0"};
  const auto draw = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = view;
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  };
  const ChildResult result = draw({"--renderer", "oracle", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::ordered_json::parse(result.out);
  EXPECT_THAT(keys(json), ElementsAre("width", "height", "renderer", "triangles", "splats",
                                      "frame_ms", "output"));
  EXPECT_EQ(json["renderer"], "oracle");
  const Image8 exact = read_png("out.png");
  ASSERT_EQ(draw({"--renderer", "gl", "--frames", "1", "--context", "osmesa"}).exit_code, 0);
  const Image8 drawn = read_png("out.png");
  EXPECT_EQ(exact.at(32, 24), glm::u8vec4(255, 0, 0, 255));
  // Only pixels whose centres lie on an edge may differ.
  EXPECT_GT(psnr_from_mse(mean_squared_error(to_float(exact), to_float(drawn))), 30);

  const auto refused = [&](const std::vector<std::string>& more, const auto&... values) {
    const ChildResult wrong = draw(more);
    EXPECT_EQ(wrong.exit_code, 2);
    EXPECT_THAT(wrong.err, Names(values...));
  };
  refused({"--renderer", "oracle", "--frames", "1"}, "--frames needs --renderer gl");
  refused({"--renderer", "tiles", "--debug-view", "depth"}, "--debug-view needs --renderer gl");
  refused({"--renderer", "tiles"}, "tiles draw only splats");
  refused({"--renderer", "rays"}, "gl, oracle, tiles, trace");
  refused({"--renderer", "oracle", "--samples", "4"}, "--samples needs --renderer trace");
  refused({"--renderer", "trace", "--samples", "4", "--supersample", "2"}, "--supersample");

  // By rays, also as the command of that name.
  ASSERT_EQ(draw({"--renderer", "trace"}).exit_code, 0);
  const Image8 traced = read_png("out.png");
  EXPECT_EQ(traced.at(32, 24), glm::u8vec4(255, 0, 0, 255));
  EXPECT_GT(psnr_from_mse(mean_squared_error(to_float(exact), to_float(traced))), 30);
  ASSERT_EQ(run({"trace", "scene.off", "--size", "64x48", "--eye", "0,-5,0", "--target", "0,0,0",
                 "--samples", "1", "--force"})
                .exit_code,
            0);
  EXPECT_EQ(read_png("out.png").pixels, traced.pixels);
}

TEST_F(Program, RenderNamesOptionsWithoutEffect) {
  write_scene();
  const Camera camera = look_at({0, -5, 0}, {0, 0, 0}, {0, 0, 1}, 0.8, 32, 24);
  write("camera.json", cameras_to_json({&camera, 1}));
  const auto says = [&](const std::string& command, const std::vector<std::string>& more,
                        const std::string& option) {
    std::vector<std::string> arguments{command, "scene.off", "--force"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ChildResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.err.find(option + " has no effect") != std::string::npos;
  };
  const std::vector<std::string> mirror{"--material", "layer 1=mirror", "--size", "32x24"};
  EXPECT_TRUE(says("render", mirror, "--material"));
  EXPECT_FALSE(says("trace", mirror, "--material"));
  const std::vector<std::string> from_file{"--camera", "camera.json", "--up", "z"};
  EXPECT_TRUE(says("render", from_file, "--up"));
  EXPECT_TRUE(says("trace", from_file, "--up"));
  EXPECT_FALSE(says("render", {"--orbit", "1", "--up", "z", "--size", "32x24"}, "--up"));
}

TEST_F(Program, TraceListsOnlyOptionsOfRays) {
  const std::string render = run({"render", "--help"}).out, trace = run({"trace", "--help"}).out;
  for (const char* option :
       {"--context", "--pipeline", "--no-specialise", "--keep NAMES", "--shading", "--blend",
        "--splat-order", "--scale", "--as-published", "--depth", "--normals", "--median-depth",
        "--alpha", "--debug-view", "--frames", "--renderer"}) {
    EXPECT_THAT(render, Names(option));
    EXPECT_EQ(trace.find(std::string("\n  ") + option), std::string::npos) << option;
  }
  for (const char* option : {"--samples", "--supersample", "--opaque", "--material", "--up"})
    EXPECT_THAT(trace, Names(std::string("\n  ") + option));
  const ChildResult other = run({"trace", "scene.off", "--context", "egl"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.err, Names("--context"));
}

TEST_F(Program, RenderSmoothsAndScalesWithoutChangingTheSize) {
  write_scene();
  const auto draw = [&](const std::vector<std::string>& option) {
    std::vector<std::string> arguments = {"render",   "scene.off", "-o",    "picture.png",
                                          "--size",   "64x48",     "--eye", "0,-5,0",
                                          "--target", "0,0,0",     "--json"};
    arguments.insert(arguments.end(), option.begin(), option.end());
    const ChildResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const Image8 image = read_png("picture.png");
    EXPECT_EQ(image.width, 64);
    EXPECT_EQ(image.height, 48);
    std::size_t between = 0;  // pixels between red and background
    for (const glm::u8vec4& pixel : image.pixels) between += pixel.r > 0 && pixel.r < 255;
    return between;
  };
  EXPECT_EQ(draw({}), 0u);
  EXPECT_GT(draw({"--supersample", "4"}), 20u);
  EXPECT_GT(draw({"--scale", "0.5"}), 20u);

  for (const auto& [option, value] : {std::pair{"--supersample", "9"}, {"--scale", "0.2"}}) {
    const ChildResult result = run({"render", "scene.off", option, value});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, Names(option));
  }
  EXPECT_EQ(run({"render", "scene.off", "--supersample", "2", "--scale", "0.5"}).exit_code, 2);
}

TEST_F(Program, RenderShowsWhatASoupHas) {
  write_scene();
  const std::vector<std::string> view = {"render", "scene.off", "--size", "64x48",     "--eye",
                                         "0,-5,0", "--target",  "0,0,0",  "--context", "osmesa"};
  const auto shown = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = view;
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  };
  const ChildResult overdraw = shown({"--debug-view", "overdraw", "--json"});
  ASSERT_EQ(overdraw.exit_code, 0) << overdraw.err;
  EXPECT_THAT(overdraw.err, Names("overdraw", "#611366 2"));
  EXPECT_THAT(keys(nlohmann::ordered_json::parse(overdraw.out)),
              ElementsAre("width", "height", "context", "renderer", "software", "triangles",
                          "splats", "frame_ms", "plan", "specialisations", "output"));
  // Two faces overlap above the middle. Below it, the third lies behind them.
  const Image8 counts = read_png("out.png");
  EXPECT_EQ(counts.at(32, 20), glm::u8vec4(0x61, 0x13, 0x66, 255));
  EXPECT_NE(counts.at(32, 30), counts.at(32, 20));
  ASSERT_EQ(shown({"--show", "normals"}).exit_code, 0);
  const Image8 normals = read_png("out.png");
  EXPECT_EQ(normals.at(32, 24), glm::u8vec4(128, 0, 128, 255));  // -y, towards the eye
  EXPECT_EQ(counts.at(0, 0), normals.at(0, 0));

  const auto refused = [&](const std::vector<std::string>& more, const auto&... values) {
    const ChildResult result = shown(more);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, Names(values...));
  };
  refused({"--show", "nomals"}, "nomals", "normals");
  refused({"--show", "texels"}, "texels");
  refused({"--show", "features:2-6"}, "features:2-6");
  refused({"--show", "depth:2"}, "depth:2");
  refused({"--show", "depth", "--supersample", "2"}, "--supersample");
  refused({"--show", "depth", "--scale", "0.5"}, "--scale");
  refused({"--show", "depth", "--frames", "5"}, "--debug-view");
}

TEST_F(Program, RenderDrawsBeyondTheDeviceInTiles) {
  write_scene();
  // Software devices draw 16,384 pixels a side.
  const std::vector<std::string> view = {
      "render", "scene.off", "--size", "20000x50",  "--eye",  "0,-5,0",       "--target",
      "0,0,0",  "--fov",     "10",     "--context", "osmesa", "--background", "transparent"};
  const ChildResult result = run(view);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Image8 image = read_png("out.png");
  ASSERT_EQ(image.width, 20000);
  ASSERT_EQ(image.height, 50);
  EXPECT_EQ(image.at(10000, 25), glm::u8vec4(255, 0, 0, 255));
  EXPECT_EQ(image.at(0, 0), glm::u8vec4(0));
  std::vector<std::string> timed = view;
  timed.insert(timed.end(), {"--frames", "3"});
  const ChildResult refused = run(timed);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, Names("--frames"));
}

TEST_F(Program, RenderShowsItsBackgroundWhereNothingIs) {
  write_scene();
  const auto corner = [&](const std::string& background) {
    EXPECT_EQ(run({"render", "scene.off", "--size", "16x16", "--background", background,
                   "--context", "osmesa"})
                  .exit_code,
              0);
    return read_png("out.png").at(0, 0);
  };
  EXPECT_EQ(corner("white"), glm::u8vec4(255));
  EXPECT_EQ(corner("transparent"), glm::u8vec4(0));
  EXPECT_EQ(corner("0,0.2,1"), glm::u8vec4(0, 51, 255, 255));
}

TEST_F(Program, RenderWritesAnOrbitAndAContactSheet) {
  write_scene();
  const ChildResult result = run({"render", "scene.off", "--orbit", "3", "--size", "40x30", "-o",
                                  "view.png", "--context", "osmesa", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(nlohmann::json::parse(result.out)["output"],
            nlohmann::json({"view_00.png", "view_01.png", "view_02.png", "contact_sheet.png"}));
  for (const char* name : {"view_00.png", "view_01.png", "view_02.png"})
    EXPECT_EQ(read_png(name).width, 40);
  EXPECT_GT(read_png("contact_sheet.png").width, 40);
  EXPECT_FALSE(exists("view.png"));
}

TEST_F(Program, RenderTakesCamerasFromAFile) {
  write_scene();
  const Camera cameras[2] = {look_at({0, -5, 0}, {0, 0, 0}, {0, 0, 1}, 0.7, 32, 24),
                             look_at({0, 5, 0}, {0, 9, 0}, {0, 0, 1}, 0.7, 20, 10)};
  write("cameras.json", cameras_to_json(cameras));
  const auto draw = [&](const std::string& camera, const std::string& output) {
    return run({"render", "scene.off", "--camera", camera, "-o", output, "--context", "osmesa"});
  };
  EXPECT_EQ(draw("cameras.json", "a.png").exit_code, 0);
  EXPECT_EQ(read_png("a.png").at(16, 12), glm::u8vec4(255, 0, 0, 255));
  EXPECT_EQ(draw("cameras.json:1", "b.png").exit_code, 0);
  EXPECT_EQ(read_png("b.png").width, 20);  // the camera's own size; it looks away
  EXPECT_EQ(read_png("b.png").at(10, 5), glm::u8vec4(0, 0, 0, 255));
  EXPECT_EQ(draw("cameras.json:all", "c.png").exit_code, 0);
  EXPECT_TRUE(exists("c_01.png"));
  const ChildResult beyond = draw("cameras.json:2", "d.png");
  EXPECT_EQ(beyond.exit_code, 2);
  EXPECT_THAT(beyond.err, Names("cameras.json:2", "0 to 1"));
}

TEST_F(Program, RenderTakesCamerasOfOtherPrograms) {
  write_scene();
  // The same view as 3D Gaussian Splatting and COLMAP write it: at (0, -5, 0), along +y, z up.
  write("cameras.json",
        R"([{"img_name": "a", "width": 32, "height": 24, "position": [0, -5, 0],
             "rotation": [[1, 0, 0], [0, 0, 1], [0, -1, 0]], "fx": 33, "fy": 33}])");
  std::filesystem::create_directories(folder / "model");
  write("model/cameras.txt", "1 PINHOLE 32 24 33 33 16 12\n");
  write("model/images.txt", "1 0.70710678118654752 0.70710678118654752 0 0 0 0 5 1 a.png\n\n");
  for (const std::string cameras : {"cameras.json", "model", "model/images.txt:0"}) {
    const ChildResult result =
        run({"render", "scene.off", "--camera", cameras, "-o", "out.png", "--context", "osmesa"});
    EXPECT_EQ(result.exit_code, 0) << cameras << ": " << result.err;
    EXPECT_EQ(read_png("out.png").at(16, 12), glm::u8vec4(255, 0, 0, 255)) << cameras;
    std::filesystem::remove(folder / "out.png");
  }
}

TEST_F(Program, NothingIsLeftWhereAnImageCannotBeWritten) {
  write_scene();
  const ChildResult result =
      run({"render", "scene.off", "--size", "8x8", "-o", "nowhere/out.png", "--context", "osmesa"});
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_THAT(result.err, Names("nowhere/out.png"));
  EXPECT_FALSE(exists("nowhere"));
}

}  // namespace program_test
}  // namespace tureen
