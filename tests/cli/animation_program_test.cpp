// Program tests of animations: frames along a path or around the scene, as images and videos.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "formats/dataset/camera_file.hpp"
#include "formats/scene_file.hpp"
#include "formats/tureen_glb/tureen_glb.hpp"
#include "image/video_file.hpp"
#include "tests/cli/program_fixture.hpp"
#include "tests/support/errors.hpp"

namespace tureen {
namespace animation_program_test {

using test::Names;
namespace fs = std::filesystem;
using test::ChildResult;
using testing::HasSubstr;
using testing::Not;
using testing::UnorderedElementsAre;

class Animation : public test::Program {
 protected:
  /// Writes three keyframes around the scene's centre, 2 s in total.
  void write_path(double loop_seconds = 0) const {
    CameraPathData path{.keyframes = {}, .loop_seconds = loop_seconds};
    for (int i = 0; i < 3; ++i)
      path.keyframes.push_back(
          {look_at({3.0 * i - 3, -5, 1}, {0, 0, 0}, {0, 0, 1}, 0.7, 40, 30), double(i), 0});
    write("path.json", path_to_json(path));
  }
  /// The names in the folder, without the program's two streams.
  std::vector<std::string> names() const {
    std::vector<std::string> result;
    for (const auto& entry : fs::directory_iterator(folder))
      if (entry.path().extension() != ".txt") result.push_back(entry.path().filename().string());
    return result;
  }
  bool same_image(const std::string& a, const std::string& b) const {
    return read_png(a).pixels == read_png(b).pixels;
  }
};

TEST_F(Animation, FramesAlongAPathPassTheViewsOfItsKeyframes) {
  write_scene();
  write_path();
  const ChildResult result =
      run({"render", "scene.off", "--path", "path.json", "--fps", "4", "-o", "frame_%04d.png"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, Names(9, "2.25 s", 4));
  EXPECT_THAT(result.err, Names("frame_0000.png", "frame_0008.png"));
  EXPECT_EQ(names().size(), 2u + 9u) << "no contact sheet";
  EXPECT_EQ(read_png("frame_0000.png").width, 40) << "the keyframes' own size";
  for (int i = 0; i < 3; ++i) {
    ASSERT_EQ(
        run({"render", "scene.off", "--camera", "path.json:" + std::to_string(i), "-o", "key.png"})
            .exit_code,
        0);
    EXPECT_TRUE(same_image("key.png", "frame_000" + std::to_string(4 * i) + ".png")) << i;
  }
  EXPECT_FALSE(same_image("frame_0000.png", "frame_0001.png"));
  EXPECT_FALSE(same_image("frame_0001.png", "frame_0002.png"));
}

TEST_F(Animation, FramesAlongTheRecordedCameras) {
  write_scene();
  EXPECT_THAT(run({"render", "scene.off", "--path", "cameras"}).err,
              HasSubstr("the scene has none"));
  Scene scene = read_scene(folder / "scene.off");
  for (int i = 0; i < 9; ++i)
    scene.cameras.push_back(look_at({0.5 * i - 2, -5, 1}, {0, 0, 0}, {0, 0, 1}, 0.7, 40, 30));
  write_tureen_glb(scene, folder / "scene.glb");
  const ChildResult result =
      run({"render", "scene.glb", "--path", "cameras:2", "--fps", "4", "-o", "f.png", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["output"].size(), 9u);
  EXPECT_EQ(json["width"], 40);
  EXPECT_FALSE(same_image(json["output"].front().get<std::string>(),
                          json["output"].back().get<std::string>()));
  EXPECT_THAT(run({"render", "scene.glb", "--path", "cameras:0"}).err,
              HasSubstr("needs seconds from 0.001"));
  if (!have_ffmpeg()) GTEST_SKIP() << ffmpeg_missing;
  EXPECT_EQ(run({"render", "scene.glb", "--path", "cameras:1", "-o", "f.mp4"}).exit_code, 0);
}

TEST_F(Animation, ALoopDoesNotShowItsFirstFrameTwice) {
  write_scene();
  write_path(3);
  const ChildResult result = run({"render", "scene.off", "--path", "path.json", "--fps", "4",
                                  "--size", "20x20", "-o", "f.png", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["output"].size(), 12u);
  EXPECT_EQ(json["output"][11], "f_11.png");
  EXPECT_EQ(json["width"], 20);
  EXPECT_FALSE(same_image("f_00.png", "f_11.png"));
}

TEST_F(Animation, ATurntableTurnsOnce) {
  write_scene();
  ASSERT_EQ(run({"render", "scene.off", "--turntable", "2", "--fps", "2", "--size", "40x30", "--up",
                 "0,0,1", "-o", "turn_%d.png"})
                .exit_code,
            0);
  EXPECT_THAT(names(), UnorderedElementsAre("scene.off", "turn_0.png", "turn_1.png", "turn_2.png",
                                            "turn_3.png"));
  // With an explicit eye, the first frame is the image from that eye.
  ASSERT_EQ(run({"render", "scene.off", "--turntable", "2", "--fps", "2", "--size", "40x30",
                 "--eye", "1,-5,2", "--target", "0,0,0", "--up", "0,0,1", "-o", "eye_%d.png"})
                .exit_code,
            0);
  ASSERT_EQ(run({"render", "scene.off", "--size", "40x30", "--eye", "1,-5,2", "--target", "0,0,0",
                 "--up", "0,0,1", "-o", "still.png"})
                .exit_code,
            0);
  EXPECT_TRUE(same_image("eye_0.png", "still.png"));
  EXPECT_FALSE(same_image("eye_2.png", "still.png"));
}

TEST_F(Animation, AVideoIsWrittenWhole) {
  if (!have_ffmpeg()) GTEST_SKIP() << ffmpeg_missing;
  write_scene();
  for (const char* name : {"turn.mp4", "turn.webm"}) {
    const ChildResult result = run({"render", "scene.off", "--turntable", "1", "--fps", "8",
                                    "--size", "64x48", "-o", name, "--json"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.err, Names(8, "1.00 s"));
    EXPECT_EQ(nlohmann::json::parse(result.out)["output"], nlohmann::json({name}));
    EXPECT_GT(fs::file_size(folder / name), 500u);
  }
  EXPECT_THAT(names(), UnorderedElementsAre("scene.off", "turn.mp4", "turn.webm"));
}

TEST_F(Animation, CtrlCLeavesNoHalfVideo) {
  if (!have_ffmpeg()) GTEST_SKIP() << ffmpeg_missing;
  write_scene();
  test::Child child(
      {"render", "scene.off", "--turntable", "3000", "--size", "320x240", "-o", "turn.mp4"},
      folder);
  const auto has_begun = [&] {
    for (const std::string& name : names())
      if (name.starts_with("turn.mp4.tmp")) return true;
    return false;
  };
  ASSERT_TRUE(child.wait_until(has_begun));
  child.signal(SIGINT);
  const ChildResult result = child.wait();
  EXPECT_NE(result.exit_code, 0);
  EXPECT_THAT(names(), Not(testing::Contains(HasSubstr("turn.mp4"))));
}

TEST_F(Animation, WhatMakesNoSenseIsSaidBeforeAnythingIsRead) {
  const auto expect = [&](std::vector<std::string> arguments, const auto&... values) {
    arguments.insert(arguments.begin(), {"render", "none.off"});
    const ChildResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments.back();
    EXPECT_THAT(result.err, Names(values...));
  };
  expect({"-o", "video.mp4"}, "video.mp4", "--path");
  expect({"--fps", "30"}, "--fps", "--path", "--turntable");
  expect({"--path", "p.json", "--orbit", "3"}, "--orbit", "--path");
  expect({"--path", "p.json", "--turntable", "3"}, "--path", "--turntable");
  expect({"--turntable", "0"}, "--turntable");
  expect({"--turntable", "3", "--background", "transparent", "-o", "f.mp4"}, "--background");
  expect({"--turntable", "3", "-o", "f.avi"}, "f.avi");
}

TEST_F(Animation, WithoutFfmpegThereIsAdvice) {
  const std::string path = std::getenv("PATH");
  setenv("PATH", folder.c_str(), 1);
  const ChildResult result = run({"render", "none.off", "--turntable", "3", "-o", "f.mp4"});
  setenv("PATH", path.c_str(), 1);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, Names("ffmpeg"));
}

TEST_F(Animation, ABadPathIsRefusedWithItsPlace) {
  write_scene();
  const Camera camera = look_at({0, -5, 1}, {0, 0, 0}, {0, 0, 1}, 0.7, 40, 30);
  write("cameras.json", cameras_to_json({&camera, 1}));
  const ChildResult timeless = run({"render", "scene.off", "--path", "cameras.json"});
  EXPECT_EQ(timeless.exit_code, 3);
  EXPECT_THAT(timeless.err, Names("cameras.json", 0, "seconds"));
  const ChildResult missing = run({"render", "scene.off", "--path", "camera.json"});
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_THAT(missing.err, Names("camera.json"));
  const ChildResult scene = run({"render", "scene.off", "--path", "scene.off"});
  EXPECT_EQ(scene.exit_code, 3);
  EXPECT_THAT(scene.err, Names("scene.off", "JSON file", "--path cameras"));
  write_path(100000);
  const ChildResult endless = run({"render", "scene.off", "--path", "path.json"});
  EXPECT_EQ(endless.exit_code, 2);
  EXPECT_THAT(endless.err, Names(100000, 3000000));
}

}  // namespace animation_program_test
}  // namespace tureen
