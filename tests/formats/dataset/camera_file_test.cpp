#include "formats/dataset/camera_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <random>

#include "formats/dataset/dataset_remarks.hpp"
#include "tests/formats/dataset/dataset_fixture.hpp"
#include "tests/formats/format_testing.hpp"
#include "tests/formats/truncation.hpp"

namespace tureen {
namespace camera_file_test {

using test::error_of;
using test::ErrorAt;
using test::ErrorIn;
using test::Refusal;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

CameraFile read(const std::string& text) {
  Input input = Input::memory("cameras.json", std::as_bytes(std::span(text)));
  return read_cameras(input);
}

std::optional<Refusal> failure(const std::string& text) {
  return error_of([&] { read(text); });
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
  // A frame's own intrinsics override the common ones.
  EXPECT_EQ(file.cameras[1].width, 320);
  EXPECT_EQ(file.cameras[1].cx, 160);
  EXPECT_THAT(file.remarks, IsEmpty());
}

TEST(CameraFile, AnAngleAloneMeansSquarePixelsAndTheUsualSize) {
  const CameraFile file = read(
      std::string("{\"camera_angle_x\": 0.6911112070083618, \"frames\": [{") + identity + "}]}");
  ASSERT_EQ(file.cameras.size(), 1u);
  EXPECT_EQ(file.cameras[0].width, 800);
  EXPECT_EQ(file.cameras[0].height, 800);
  // The known focal length of the NeRF synthetic scenes.
  EXPECT_NEAR(file.cameras[0].fx, 1111.1110, 1e-3);
  EXPECT_EQ(file.cameras[0].fx, file.cameras[0].fy);
  EXPECT_EQ(file.cameras[0].cx, 400);
  EXPECT_THAT(file.remarks,
              ElementsAre(Remark{&remarks::image_size_missing, {{"width", 800}, {"height", 800}}}));
}

TEST(CameraFile, RemarksThatDistortionIsIgnored) {
  const CameraFile file =
      read(std::string("{\"fl_x\": 9, \"w\": 8, \"h\": 8, \"k1\": 0.05, \"frames\": [{") +
           identity + "}]}");
  EXPECT_THAT(file.remarks, ElementsAre(Remark{&remarks::lens_dropped}));
}

TEST(CameraFile, RefusesWithTheFileTheCameraAndTheReason) {
  const auto frame = [](const std::string& head, const std::string& matrix) {
    return "{" + head + "\"frames\": [{\"transform_matrix\": " + matrix + "}]}";
  };
  const std::string good = "[[1,0,0,0],[0,1,0,0],[0,0,1,0]]";
  EXPECT_THAT(failure("{\"frames\": [}"), ErrorAt("cameras.json@12"));
  EXPECT_THAT(failure("{\"frames\": [1e999]}"), ErrorAt("cameras.json@12", "1e999"));
  EXPECT_THAT(failure(R"({"note": "1e999", "frames": [1e999]})"), ErrorAt("cameras.json", "1e999"));
  EXPECT_THAT(failure("7"), ErrorAt("cameras.json"));
  EXPECT_THAT(failure("{}"), ErrorAt("cameras.json"));
  EXPECT_THAT(failure("{\"frames\": 3}"), ErrorAt("cameras.json", "frames"));
  EXPECT_THAT(failure(frame("", good)), ErrorAt("cameras.json", 0, "fl_x", "camera_angle_x"));
  EXPECT_THAT(failure(frame("\"fl_x\": -1, ", good)), ErrorAt("cameras.json", 0));
  EXPECT_THAT(failure(frame("\"fl_x\": 1, \"w\": 1e9, ", good)), ErrorAt("cameras.json", 0, "w"));
  EXPECT_THAT(failure(frame("\"camera_angle_x\": 4, ", good)),
              ErrorAt("cameras.json", "camera_angle_x"));
  EXPECT_THAT(failure(frame("\"fl_x\": \"a\", ", good)), ErrorAt("cameras.json", "fl_x"));
  EXPECT_THAT(failure(frame("\"fl_x\": 1, ", "[[2,0,0,0],[0,2,0,0],[0,0,2,0]]")),
              ErrorAt("cameras.json", "transform_matrix"));
  EXPECT_THAT(failure(frame("\"fl_x\": 1, ", "[[1,0,0,0],[0,1,0,0],[0,0,1,0],[1,2,3,4]]")),
              ErrorAt("cameras.json", "transform_matrix", 0, 1));
  EXPECT_THAT(failure(frame("\"fl_x\": 1, ", "[[-1,0,0,0],[0,1,0,0],[0,0,1,0]]")),
              ErrorAt("cameras.json", "transform_matrix"));
  EXPECT_THAT(failure(frame("\"fl_x\": 1, ", "[[1,0,0],[0,1,0],[0,0,1]]")),
              ErrorAt("cameras.json", 0, 4));
  EXPECT_THAT(failure(frame("\"fl_x\": 1, ", "[]")), ErrorAt("cameras.json", 0, 3, 4));
  EXPECT_THAT(failure("{\"tureen_cameras\": 2, \"cameras\": []}"), ErrorAt("cameras.json", 1));
  EXPECT_THAT(failure("{\"cameras\": [{}]}"), ErrorAt("cameras.json", 0, "width"));
  EXPECT_THAT(failure("{\"cameras\": [7]}"), ErrorAt("cameras.json", 0));
}

/// In the format of 3D Gaussian Splatting: at (1, 2, 3), along +y, z up.
const std::string gaussian =
    "[{\"id\": 0, \"img_name\": \"0001\", \"width\": 640, \"height\": 360, \"position\": [1, 2, "
    "3], "
    "\"rotation\": [[1, 0, 0], [0, 0, 1], [0, -1, 0]], \"fy\": 490.5, \"fx\": 500}]";

/// `gaussian` with `part` replaced.
std::string gaussian_with(const std::string& part, const std::string& replacement) {
  std::string text = gaussian;
  return text.replace(text.find(part), part.size(), replacement);
}

TEST(CameraFile, ReadsCamerasOfGaussianSplatting) {
  const CameraFile file = read(gaussian);
  ASSERT_EQ(file.cameras.size(), 1u);
  const Camera& camera = file.cameras[0];
  EXPECT_EQ(camera.name, "0001");
  EXPECT_EQ(camera.width, 640);
  EXPECT_EQ(camera.height, 360);
  EXPECT_EQ(camera.fx, 500);
  EXPECT_EQ(camera.fy, 490.5);
  EXPECT_EQ(camera.cx, 320);
  EXPECT_EQ(camera.cy, 180);
  EXPECT_LT(glm::length(camera.eye() - glm::dvec3(1, 2, 3)), 1e-12);
  const glm::dmat3 axes = camera.world_from_view_rotation();
  EXPECT_LT(glm::length(axes[0] - glm::dvec3(1, 0, 0)), 1e-12);
  EXPECT_LT(glm::length(axes[1] - glm::dvec3(0, 0, 1)), 1e-12);
  EXPECT_LT(glm::length(-axes[2] - glm::dvec3(0, 1, 0)), 1e-12);
  EXPECT_THAT(file.remarks, IsEmpty());
  // Some descendants add these members.
  EXPECT_EQ(read(gaussian_with("\"id\": 0", "\"cx\": 301.5")).cameras[0].cx, 301.5);
  EXPECT_THAT(read("[]").cameras, IsEmpty());
}

TEST(CameraFile, RefusesCamerasOfGaussianSplattingWithTheReason) {
  const auto expect = [](const char* part, const char* replacement, const auto&... values) {
    EXPECT_THAT(failure(gaussian_with(part, replacement)), ErrorAt("cameras.json", values...));
  };
  expect("640", "0", 0, "width");
  expect("500", "-500", 0, "a");
  expect("\"fx\"", "\"f\"", 0, "fx");
  expect("[1, 2, 3]", "[1, 2]", 0, "position");
  expect("[1, 2, 3]", "[1, null, 3]", 0, "position");
  expect("\"position\"", "\"p\"", 0, "position");
  expect("[1, 0, 0]", "[2, 0, 0]", 0, "rotation");
  expect("[1, 0, 0]", "[-1, 0, 0]", 0, "rotation");
  expect("[1, 0, 0]", "[1, 0, 0, 0]", 0, "rotation");
  expect("[1, 0, 0], ", "", 0, "rotation");
  EXPECT_THAT(failure("[7]"), ErrorAt("cameras.json", 0));
}

TEST(CameraFile, CamerasOfGaussianSplattingSurviveDamage) {
  const auto read_bytes = [](std::span<const std::byte> bytes) {
    Input input = Input::memory("cameras.json", bytes);
    read_cameras(input);
  };
  const auto whole = std::as_bytes(std::span(gaussian));
  EXPECT_GT(test::survive_damage(whole, read_bytes).refused, 0u);
  EXPECT_EQ(test::survive_truncation(whole, read_bytes).read, 0u);
}

/// Three images, not in name order, with two cameras, one of them with distortion.
test::ColmapFixture colmap_fixture() {
  test::ColmapFixture model = test::upright_colmap(3);
  std::swap(model.images[0], model.images[2]);
  model.cameras.push_back({2, 2, "SIMPLE_RADIAL", 641, 480, {502, 320, 240, 0.125}});
  model.images[1].camera = 2;
  return model;
}

TEST(CameraFile, ReadsAModelByColmapInBothForms) {
  const test::TemporaryFolder folder;
  test::write_binary(folder / "binary", colmap_fixture());
  test::write_text(folder / "dataset/sparse/0", colmap_fixture());
  for (const char* name : {"binary", "binary/images.bin", "binary/cameras.bin", "dataset",
                           "dataset/sparse/0", "dataset/sparse/0/images.txt"}) {
    SCOPED_TRACE(name);
    EXPECT_TRUE(is_camera_file(folder / name));
    const CameraFile file = read_cameras(folder / name);
    ASSERT_EQ(file.cameras.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
      const Camera& camera = file.cameras[i];
      EXPECT_EQ(camera.name, std::string(1, char('a' + i)) + ".png");
      EXPECT_EQ(camera.width, i == 1 ? 641 : 8);
      EXPECT_EQ(camera.fx, i == 1 ? 502 : 10);
      EXPECT_EQ(camera.cy, i == 1 ? 240 : 2.5);
      // An upright camera with the translation (x, 0.5, 3) is at the negative of it, with y down.
      EXPECT_LT(glm::length(camera.eye() - glm::dvec3(-0.25 * double(i), -0.5, -3)), 1e-12);
      EXPECT_EQ(camera.view_from_world * glm::dvec4(0, 0, 0, 1),
                glm::dvec4(0.25 * double(i), -0.5, -3, 1));
    }
    EXPECT_THAT(file.remarks, ElementsAre(Remark{&remarks::lens_dropped}));
  }
}

TEST(CameraFile, OtherFilesAndFoldersAreNoCameraFiles) {
  const test::TemporaryFolder folder;
  test::write_text(folder / "cameras.txt", "1 PINHOLE 8 6 10 9 4 3");  // images.txt is missing
  test::write_text(folder / "scene.off", "OFF\n0 0 0\n");
  test::write_text(folder / "cameras.json", " \n[");
  EXPECT_FALSE(is_camera_file(folder / ""));
  EXPECT_FALSE(is_camera_file(folder / "cameras.txt"));
  EXPECT_FALSE(is_camera_file(folder / "scene.off"));
  EXPECT_FALSE(is_camera_file(folder / "none.json"));
  EXPECT_TRUE(is_camera_file(folder / "cameras.json"));
  EXPECT_THAT(error_of([&] { read_cameras(folder / "cameras.json"); }), ErrorAt("cameras.json@3"));
}

TEST(CameraFile, SkipsPosesThatCannotBeUsed) {
  const test::TemporaryFolder folder;
  test::ColmapFixture model = colmap_fixture();
  model.images[0].camera = 9;
  test::write_text(folder / "model", model);
  // Two would be left.
  EXPECT_THAT(error_of([&] { read_cameras(folder / "model"); }), ErrorIn("model", 9));
  model.images.push_back(model.images[1]);
  model.images.back().name = "d.png";
  test::write_text(folder / "model", model);
  const CameraFile cameras = read_cameras(folder / "model");
  EXPECT_EQ(cameras.cameras.size(), 3u);
  EXPECT_THAT(described(cameras.remarks),
              ::testing::Contains(::testing::HasSubstr("its camera 9 is missing")));
}

TEST(CameraFile, TransformsSurviveDamage) {
  const std::string whole =
      std::string("{\"fl_x\": 9, \"fl_y\": 8, \"cx\": 4, \"cy\": 3, \"w\": 8, ") +
      "\"h\": 6, \"k1\": 0.1, \"k4\": 0, \"camera_model\": \"OPENCV\", " +
      "\"frames\": [{\"file_path\": \"a\", " + identity + "}]}";
  const auto survival =
      test::survive_damage(std::as_bytes(std::span(whole)), [](std::span<const std::byte> bytes) {
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
  EXPECT_THAT(failure(""), ErrorAt("cameras.json@0"));
  for (std::size_t length = 1; length + 2 < whole.size(); ++length)
    EXPECT_THAT(failure(whole.substr(0, length)), ErrorIn("cameras.json")) << length;
}

}  // namespace camera_file_test
}  // namespace tureen
