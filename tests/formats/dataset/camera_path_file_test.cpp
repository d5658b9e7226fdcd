#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "formats/dataset/camera_file.hpp"
#include "tests/formats/format_testing.hpp"
#include "tests/formats/truncation.hpp"
#include "tests/support/random.hpp"

namespace tureen {
namespace camera_path_file_test {

using test::error_of;
using test::ErrorAt;
using test::ErrorIn;
using test::Refusal;

CameraPathData read(const std::string& text) {
  Input input = Input::memory("path.json", std::as_bytes(std::span(text)));
  return read_path(input);
}

std::optional<Refusal> failure(const std::string& text) {
  return error_of([&] { read(text); });
}

CameraPathData random_path(test::Random& random) {
  CameraPathData path;
  double seconds = 0;
  for (int i = 1 + int(random.below(6)); i > 0; --i) {
    const double distance = random.uniform(0.1, 5);
    CameraKeyframe keyframe{
        look_at(distance * random.direction(), {0, 0, 0}, {0, 0, 1}, 0.7, 640, 360), seconds,
        random.chance(0.5) ? distance : 0.0};
    keyframe.camera.cx += random.uniform(-9, 9);
    keyframe.camera.name = "key \"" + std::to_string(i) + "\"";
    path.keyframes.push_back(keyframe);
    if (random.chance(0.8)) seconds += random.uniform(0, 3);
  }
  if (random.chance(0.5)) path.loop_seconds = seconds + random.uniform(0.1, 3);
  return path;
}

/// One camera of a file; `fields` come before its other fields.
std::string camera(const std::string& fields) {
  return "{" + fields + R"( "width": 8, "height": 6, "fx": 9, "fy": 9, "cx": 4, "cy": 3,
      "view_from_world": [[1,0,0,0],[0,1,0,0],[0,0,1,-2]]})";
}

std::string file(const std::string& head, const std::string& cameras) {
  return "{\"tureen_cameras\": 1, " + head + "\"cameras\": [" + cameras + "]}";
}

TEST(CameraPathFile, KeepsEveryBit) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    test::Random random(seed);
    const CameraPathData path = random_path(random);
    const std::string text = path_to_json(path);
    const CameraPathData back = read(text);
    EXPECT_EQ(back.loop_seconds, path.loop_seconds);
    ASSERT_EQ(back.keyframes.size(), path.keyframes.size());
    for (std::size_t i = 0; i < path.keyframes.size(); ++i) {
      const CameraKeyframe &a = path.keyframes[i], &b = back.keyframes[i];
      EXPECT_EQ(a.seconds, b.seconds);
      EXPECT_EQ(a.target_distance, b.target_distance);
      EXPECT_EQ(a.camera.name, b.camera.name);
      EXPECT_EQ(a.camera.fx, b.camera.fx);
      EXPECT_EQ(a.camera.cx, b.camera.cx);
      EXPECT_EQ(a.camera.view_from_world, b.camera.view_from_world);
    }
    EXPECT_EQ(path_to_json(back), text);
  }
}

TEST(CameraPathFile, IsReadByWhateverReadsCameras) {
  test::Random random(3);
  const CameraPathData path = random_path(random);
  const std::string text = path_to_json(path);
  Input input = Input::memory("path.json", std::as_bytes(std::span(text)));
  const CameraFile cameras = read_cameras(input);
  ASSERT_EQ(cameras.cameras.size(), path.keyframes.size());
  EXPECT_EQ(cameras.cameras.back().view_from_world, path.keyframes.back().camera.view_from_world);
}

TEST(CameraPathFile, AFileWrittenByHandNeedsLittle) {
  const CameraPathData path =
      read(R"({"cameras": [)" + camera("\"seconds\": 0,") + "," + camera("\"seconds\": 2,") + "]}");
  EXPECT_EQ(path.keyframes.size(), 2u);
  EXPECT_EQ(path.loop_seconds, 0);
  EXPECT_EQ(path.keyframes[1].target_distance, 0);
  // Without "loop_seconds", a loop returns after the average time between keyframes.
  const std::string three =
      camera("\"seconds\": 1,") + "," + camera("\"seconds\": 2,") + "," + camera("\"seconds\": 5,");
  EXPECT_EQ(read(file("\"loop\": true, ", three)).loop_seconds, 6);
  EXPECT_EQ(read(file("\"loop\": true, \"loop_seconds\": 4.5, ", three)).loop_seconds, 4.5);
  EXPECT_EQ(read(file("\"loop\": false, \"loop_seconds\": 4.5, ", three)).loop_seconds, 0);
  EXPECT_EQ(read(file("\"loop\": true, ", camera("\"seconds\": 1,"))).loop_seconds, 1);
}

TEST(CameraPathFile, WrongOnesAreRefusedWithFileAndPlace) {
  const std::string first = camera("\"seconds\": 1,") + ",";
  EXPECT_THAT(failure(file("", first + camera(""))), ErrorAt("path.json", 1, "seconds"));
  EXPECT_THAT(failure(file("", first + camera("\"seconds\": \"2\","))),
              ErrorAt("path.json", 1, "seconds"));
  EXPECT_THAT(failure(file("", first + camera("\"seconds\": 0.5,"))),
              ErrorAt("path.json", 1, "seconds"));
  for (const char* seconds : {"-1", "1e7"})
    EXPECT_THAT(failure(file("", camera(std::string("\"seconds\": ") + seconds + ","))),
                ErrorAt("path.json", 0, "seconds", 1000000));
  EXPECT_THAT(failure(file("", camera("\"seconds\": 0, \"target_distance\": -1,"))),
              ErrorAt("path.json", 0, "target_distance"));
  EXPECT_THAT(failure(file("\"loop\": 1, ", camera("\"seconds\": 0,"))),
              ErrorAt("path.json", "loop"));
  EXPECT_THAT(failure(file("\"loop\": true, \"loop_seconds\": \"8\", ", camera("\"seconds\": 0,"))),
              ErrorAt("path.json", "loop_seconds"));
  EXPECT_THAT(failure(file("\"loop\": true, \"loop_seconds\": 0, ", camera("\"seconds\": 0,"))),
              ErrorAt("path.json", "loop_seconds", 0, 1000000));
  EXPECT_THAT(failure(file("", "")), ErrorAt("path.json"));
  EXPECT_THAT(failure("{\"frames\": []}"), ErrorAt("path.json"));
  EXPECT_THAT(failure("[]"), ErrorAt("path.json"));
  EXPECT_THAT(failure("{\"tureen_cameras\": 2, \"cameras\": []}"), ErrorAt("path.json", 1));
  EXPECT_THAT(failure("{"), ErrorIn("path.json"));
}

TEST(CameraPathFile, SurvivesDamage) {
  test::Random random(5);
  CameraPathData path = random_path(random);
  path.keyframes.resize(1);
  const std::string whole = path_to_json(path);
  const auto survival =
      test::survive_damage(std::as_bytes(std::span(whole)), [](std::span<const std::byte> bytes) {
        Input input = Input::memory("path.json", bytes);
        read_path(input);
      });
  EXPECT_GT(survival.read, 0u);
  EXPECT_GT(survival.refused, 0u);
}

}  // namespace camera_path_file_test
}  // namespace tureen
