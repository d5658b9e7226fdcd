#include "formats/camera_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <random>

#include "formats/truncation.hpp"

namespace tureen {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

CameraFile read(const std::string& text) {
  Input input = Input::memory("cameras.json", std::as_bytes(std::span(text)));
  return read_cameras(input);
}

std::string failure(const std::string& text) {
  try {
    read(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing thrown";
}

TEST(CameraFile, OurOwnKeepsEveryBit) {
  const unsigned seed = 5;
  SCOPED_TRACE(::testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-5, 5);
  std::vector<Camera> cameras;
  for (int i = 0; i < 50; ++i) {
    cameras.push_back(look_at({uniform(random), uniform(random), uniform(random)},
                              {uniform(random), uniform(random), uniform(random)}, {0, 0, 1}, 0.7,
                              640, 360));
    cameras.back().fx *= 1.01;
    cameras.back().cx += uniform(random);
    cameras.back().name = "view \"" + std::to_string(i) + "\"";
  }
  const CameraFile result = read(cameras_to_json(cameras));
  ASSERT_EQ(result.cameras.size(), cameras.size());
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const Camera &a = cameras[i], &b = result.cameras[i];
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.width, b.width);
    EXPECT_EQ(a.height, b.height);
    EXPECT_EQ(a.fx, b.fx);
    EXPECT_EQ(a.fy, b.fy);
    EXPECT_EQ(a.cx, b.cx);
    EXPECT_EQ(a.cy, b.cy);
    EXPECT_EQ(a.view_from_world, b.view_from_world);
  }
}

TEST(CameraFile, ANameThatIsNotUtf8IsWrittenAllTheSame) {
  Camera camera = look_at({0, 0, 1}, {0, 0, 0}, {0, 1, 0}, 0.7, 8, 8);
  camera.name = "caf\xe9";
  EXPECT_EQ(read(cameras_to_json({&camera, 1})).cameras.size(), 1u);
}

const char* const identity = "\"transform_matrix\": [[1,0,0,1],[0,0,-1,2],[0,1,0,3],[0,0,0,1]]";

TEST(CameraFile, ReadsTransformsWithFullIntrinsics) {
  const CameraFile file = read(std::string(R"({"fl_x": 500, "fl_y": 490.5, "cx": 310, "cy": 170.5,
      "w": 640.0, "h": 360, "frames": [{"file_path": "images/1.jpg", )") +
                               identity + "}, {\"w\": 320, \"cx\": 160, " + identity + "}]}");
  ASSERT_EQ(file.cameras.size(), 2u);
  const Camera& camera = file.cameras[0];
  EXPECT_EQ(camera.name, "images/1.jpg");
  EXPECT_EQ(camera.width, 640);
  EXPECT_EQ(camera.height, 360);
  EXPECT_EQ(camera.fx, 500);
  EXPECT_EQ(camera.fy, 490.5);
  EXPECT_EQ(camera.cx, 310);
  EXPECT_EQ(camera.cy, 170.5);
  EXPECT_LT(glm::length(camera.eye() - glm::dvec3(1, 2, 3)), 1e-12);
  // The third column of the matrix is backward: the camera looks along +y with z up.
  const glm::dmat3 axes = camera.world_from_view_rotation();
  EXPECT_LT(glm::length(-axes[2] - glm::dvec3(0, 1, 0)), 1e-12);
  EXPECT_LT(glm::length(axes[1] - glm::dvec3(0, 0, 1)), 1e-12);
  // A frame's own numbers stand above the common ones.
  EXPECT_EQ(file.cameras[1].width, 320);
  EXPECT_EQ(file.cameras[1].cx, 160);
  EXPECT_THAT(file.notes, IsEmpty());
}

TEST(CameraFile, AnAngleAloneMeansSquarePixelsAndTheUsualSize) {
  const CameraFile file = read(
      std::string("{\"camera_angle_x\": 0.6911112070083618, \"frames\": [{") + identity + "}]}");
  ASSERT_EQ(file.cameras.size(), 1u);
  EXPECT_EQ(file.cameras[0].width, 800);
  EXPECT_EQ(file.cameras[0].height, 800);
  // The focal length that the NeRF synthetic scenes are known by.
  EXPECT_NEAR(file.cameras[0].fx, 1111.1110, 1e-3);
  EXPECT_EQ(file.cameras[0].fx, file.cameras[0].fy);
  EXPECT_EQ(file.cameras[0].cx, 400);
  EXPECT_THAT(file.notes, ElementsAre(HasSubstr("800 x 800 is assumed")));
}

TEST(CameraFile, SaysThatDistortionIsLeftOut) {
  const CameraFile file =
      read(std::string("{\"fl_x\": 9, \"w\": 8, \"h\": 8, \"k1\": 0.05, \"frames\": [{") +
           identity + "}]}");
  EXPECT_THAT(file.notes, ElementsAre(HasSubstr("lens distortion")));
}

TEST(CameraFile, RefusesWithTheFileTheCameraAndTheReason) {
  const auto frame = [](const std::string& head, const std::string& matrix) {
    return "{" + head + "\"frames\": [{\"transform_matrix\": " + matrix + "}]}";
  };
  const std::string good = "[[1,0,0,0],[0,1,0,0],[0,0,1,0]]";
  EXPECT_THAT(failure("{\"frames\": [}"), HasSubstr("cameras.json: byte 12: not valid JSON"));
  EXPECT_THAT(failure("{\"frames\": [1e999]}"), HasSubstr("JSON that cannot be read"));
  EXPECT_THAT(failure("[]"), HasSubstr("no JSON object"));
  EXPECT_THAT(failure("{}"), HasSubstr("no camera file that we know"));
  EXPECT_THAT(failure("{\"frames\": 3}"), HasSubstr("frames is no list"));
  EXPECT_THAT(failure(frame("", good)), HasSubstr("frame 0: neither fl_x nor camera_angle_x"));
  EXPECT_THAT(failure(frame("\"fl_x\": -1, ", good)), HasSubstr("focal length is not positive"));
  EXPECT_THAT(failure(frame("\"fl_x\": 1, \"w\": 1e9, ", good)), HasSubstr("w is no whole number"));
  EXPECT_THAT(failure(frame("\"camera_angle_x\": 4, ", good)), HasSubstr("outside 0..pi"));
  EXPECT_THAT(failure(frame("\"fl_x\": \"a\", ", good)), HasSubstr("fl_x is no number"));
  EXPECT_THAT(failure(frame("\"fl_x\": 1, ", "[[2,0,0,0],[0,2,0,0],[0,0,2,0]]")),
              HasSubstr("transform_matrix is no rotation"));
  EXPECT_THAT(failure(frame("\"fl_x\": 1, ", "[[-1,0,0,0],[0,1,0,0],[0,0,1,0]]")),
              HasSubstr("transform_matrix mirrors"));
  EXPECT_THAT(failure(frame("\"fl_x\": 1, ", "[[1,0,0],[0,1,0],[0,0,1]]")), HasSubstr("4 numbers"));
  EXPECT_THAT(failure(frame("\"fl_x\": 1, ", "[]")), HasSubstr("3 or 4 rows"));
  EXPECT_THAT(failure("{\"tureen_cameras\": 2, \"cameras\": []}"), HasSubstr("version 1"));
  EXPECT_THAT(failure("{\"cameras\": [{}]}"), HasSubstr("camera 0: width is missing"));
  EXPECT_THAT(failure("{\"cameras\": [7]}"), HasSubstr("camera 0: it is no object"));
}

TEST(CameraFile, TransformsSurviveDamage) {
  const std::string whole =
      std::string("{\"fl_x\": 9, \"fl_y\": 8, \"cx\": 4, \"cy\": 3, \"w\": 8, ") +
      "\"h\": 6, \"k1\": 0.1, \"k4\": 0, \"camera_model\": \"OPENCV\", " +
      "\"frames\": [{\"file_path\": \"a\", " + identity + "}]}";
  const auto survival = testing::survive_damage(
      std::as_bytes(std::span(whole)), [](std::span<const std::byte> bytes) {
        Input input = Input::memory("cameras.json", bytes);
        read_cameras(input);
      });
  EXPECT_GT(survival.read, 0u);
  EXPECT_GT(survival.refused, 0u);
}

TEST(CameraFile, SurvivesEveryTruncation) {
  const Camera camera = look_at({1, 2, 3}, {0, 0, 0}, {0, 1, 0}, 0.7, 64, 48);
  const std::string whole = cameras_to_json({&camera, 1});
  // The last two bytes are the closing brace and the line's end.
  for (std::size_t length = 0; length + 2 < whole.size(); ++length)
    EXPECT_THAT(failure(whole.substr(0, length)), HasSubstr("not valid JSON")) << length;
}

}  // namespace
}  // namespace tureen
