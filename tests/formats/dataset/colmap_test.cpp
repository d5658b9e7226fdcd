#include "formats/dataset/colmap.hpp"

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <random>

#include "tests/formats/dataset/dataset_fixture.hpp"
#include "tests/formats/format_testing.hpp"
#include "tests/formats/truncation.hpp"

namespace tureen {
namespace colmap_test {

using namespace tureen::test;

Input input_of_bytes(std::span<const std::byte> bytes, const std::string& name) {
  return Input::memory(name, bytes);
}

/// Every readable model, images with and without features, points with and without observations.
ColmapFixture varied() {
  ColmapFixture model;
  model.cameras = {{1, 0, "SIMPLE_PINHOLE", 640, 480, {500, 320.5, 240.25}},
                   {2, 1, "PINHOLE", 640, 481, {500, 501, 320, 240}},
                   {9, 2, "SIMPLE_RADIAL", 641, 480, {502, 320, 240, 0.125}},
                   {4, 3, "RADIAL", 642, 480, {503, 320, 240, 0.125, -0.0625}},
                   {70000, 4, "OPENCV", 643, 480, {504, 505, 320, 240, 0.1, 0.2, 0.3, 0.4}}};
  // Rotations: a third of a turn around (1, 1, 1), none, and an irregular one.
  const double odd = std::sqrt(1 - 0.09 - 0.16 - 0.01);
  model.images = {{1, {0.5, 0.5, 0.5, 0.5}, {1, 2, 3}, 9, "first.jpg", 2},
                  {5, {1, 0, 0, 0}, {0, 0, 5}, 1, "sub/second.jpg", 0},
                  {3, {odd, 0.3, -0.4, 0.1}, {1e-7, -1e5, 1.0 / 3}, 70000, "third.png", 1}};
  model.points = {{1, {0.1, 0.2, 0.3}, {1, 2, 3}, 0},
                  {1ull << 40, {-1e9, 1e-9, 2.0 / 3}, {255, 0, 128}, 3}};
  return model;
}

TEST(Colmap, MapsTheParametersOfEveryModel) {
  const auto bytes = binary_cameras(varied());
  Input input = input_of_bytes(bytes, "cameras.bin");
  const ColmapCameras cameras = read_colmap_cameras_binary(input);
  ASSERT_EQ(cameras.size(), 5u);
  const auto expect = [&](std::uint32_t number, glm::dvec4 pinhole, const Lens& lens) {
    const ColmapCamera& camera = cameras.at(number);
    EXPECT_EQ(
        glm::dvec4(camera.pinhole.fx, camera.pinhole.fy, camera.pinhole.cx, camera.pinhole.cy),
        pinhole)
        << number;
    EXPECT_EQ(camera.lens, lens) << number;
  };
  expect(1, {500, 500, 320.5, 240.25}, {});
  expect(2, {500, 501, 320, 240}, {});
  expect(9, {502, 502, 320, 240}, {.k1 = 0.125});
  expect(4, {503, 503, 320, 240}, {.k1 = 0.125, .k2 = -0.0625});
  expect(70000, {504, 505, 320, 240}, {.k1 = 0.1, .k2 = 0.2, .p1 = 0.3, .p2 = 0.4});
  EXPECT_EQ(cameras.at(4).pinhole.width, 642);
  EXPECT_EQ(cameras.at(2).pinhole.height, 481);
}

TEST(Colmap, TextIsTheSameAsBinary) {
  const TemporaryFolder folder;
  write_binary(folder / "binary", varied());
  write_text(folder / "text", varied());
  const ColmapModel a = read_colmap(folder / "binary"), b = read_colmap(folder / "text");
  ASSERT_EQ(a.cameras.size(), b.cameras.size());
  for (const auto& [number, camera] : a.cameras) {
    const ColmapCamera& other = b.cameras.at(number);
    EXPECT_EQ(camera.lens, other.lens);
    EXPECT_EQ(camera.pinhole.width, other.pinhole.width);
    EXPECT_EQ(camera.pinhole.height, other.pinhole.height);
    EXPECT_EQ(camera.pinhole.fx, other.pinhole.fx);
    EXPECT_EQ(camera.pinhole.fy, other.pinhole.fy);
    EXPECT_EQ(camera.pinhole.cx, other.pinhole.cx);
    EXPECT_EQ(camera.pinhole.cy, other.pinhole.cy);
  }
  ASSERT_EQ(a.images.size(), 3u);
  ASSERT_EQ(b.images.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(a.images[i].name, b.images[i].name);
    EXPECT_EQ(a.images[i].camera, b.images[i].camera);
    EXPECT_EQ(a.images[i].view_from_world, b.images[i].view_from_world);
  }
  ASSERT_EQ(a.points.size(), 2u);
  ASSERT_EQ(b.points.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(a.points[i].position, b.points[i].position);
    EXPECT_EQ(a.points[i].color, b.points[i].color);
  }
  EXPECT_EQ(a.points[1].position, glm::dvec3(-1e9, 1e-9, 2.0 / 3));
  EXPECT_EQ(a.points[1].color, glm::u8vec3(255, 0, 128));
}

TEST(Colmap, PosesBecomeOpenGl) {
  const auto bytes = binary_images(varied());
  Input input = input_of_bytes(bytes, "images.bin");
  const auto images = read_colmap_images_binary(input);
  ASSERT_EQ(images.size(), 3u);
  EXPECT_EQ(images[1].name, "sub/second.jpg");
  // COLMAP sees the origin 5 in front of the camera, (0, 1, 0) below it and (1, 0, 0) to the right.
  const glm::dmat4& straight = images[1].view_from_world;
  EXPECT_EQ(straight * glm::dvec4(0, 0, 0, 1), glm::dvec4(0, 0, -5, 1));
  EXPECT_EQ(straight * glm::dvec4(0, 1, 0, 1), glm::dvec4(0, -1, -5, 1));
  EXPECT_EQ(straight * glm::dvec4(1, 0, 0, 1), glm::dvec4(1, 0, -5, 1));
  // The third of a turn maps x to y, y to z, z to x. Then the translation (1, 2, 3) follows.
  const glm::dvec4 turned = images[0].view_from_world * glm::dvec4(10, 20, 30, 1);
  EXPECT_LT(glm::length(turned - glm::dvec4(31, -12, -23, 1)), 1e-12);
}

TEST(Colmap, ReadsTextAsPeopleEditIt) {
  const std::string text =
      "# comment\r\n\r\n  3 1 0 0 0 0 0 1 1 with a blank.jpg\r\n\r\n"
      "# another\r\n4 1 0 0 0 0 0 1 1 last#1.jpg";
  Input input = input_of(text, "images.txt");
  const auto images = read_colmap_images_text(input);
  ASSERT_EQ(images.size(), 2u);
  EXPECT_EQ(images[0].name, "with a blank.jpg");
  EXPECT_EQ(images[1].name, "last#1.jpg");
}

// Without these lines, every second image would be read as the features of the previous one.
TEST(Colmap, MissesTheLineOfFeatures) {
  const std::string text = "1 1 0 0 0 0 0 1 1 a.jpg\n2 1 0 0 0 0 0 1 1 b.jpg\n";
  Input input = input_of(text, "images.txt");
  EXPECT_THAT(error_of([&] { read_colmap_images_text(input); }), ErrorAt("images.txt:2", "a.jpg"));
}

TEST(Colmap, FindsItsFolder) {
  const TemporaryFolder folder;
  EXPECT_FALSE(colmap_folder(folder / ""));
  write_text(folder / "colmap/sparse/0/cameras.txt", "");
  EXPECT_EQ(colmap_folder(folder / ""), (folder / "") / "colmap/sparse/0");
  write_text(folder / "sparse/cameras.bin", "");
  EXPECT_EQ(colmap_folder(folder / ""), (folder / "") / "sparse");
  write_text(folder / "sparse/0/cameras.bin", "");
  EXPECT_EQ(colmap_folder(folder / ""), (folder / "") / "sparse/0");
}

// ---- Errors ---------------------------------------------------------------------------------

/// The errors from reading this camera in both forms; they differ only in the place.
std::array<std::optional<Refusal>, 2> camera_errors(const ColmapFixture::CameraRecord& camera) {
  ColmapFixture model;
  model.cameras = {camera};
  const auto bytes = binary_cameras(model);
  const std::string text = text_cameras(model);
  Input binary_input = input_of_bytes(bytes, "cameras.bin");
  Input text_input = input_of(text, "cameras.txt");
  return {error_of([&] { read_colmap_cameras_binary(binary_input); }),
          error_of([&] { read_colmap_cameras_text(text_input); })};
}

TEST(Colmap, RefusesOtherModelsByName) {
  const std::pair<int, const char*> others[] = {
      {6, "FULL_OPENCV"}, {7, "FOV"}, {10, "THIN_PRISM_FISHEYE"}};
  for (const auto& [number, name] : others) {
    const auto errors = camera_errors({1, number, name, 8, 8, {1, 1, 1, 1, 0, 0, 0, 0}});
    EXPECT_THAT(errors[0], ErrorAt("cameras.bin@8"));
    EXPECT_THAT(errors[1], ErrorAt("cameras.txt:3"));
    for (const auto& error : errors)
      EXPECT_THAT(error, Names(name, "SIMPLE_PINHOLE", "PINHOLE", "SIMPLE_RADIAL", "RADIAL",
                               "OPENCV", "image_undistorter"));
  }
  EXPECT_THAT(camera_errors({1, 99, "MYSTERY", 8, 8, {1}})[0], ErrorAt("cameras.bin@8", 99));
  EXPECT_THAT(camera_errors({1, -1, "MYSTERY", 8, 8, {1}})[0], ErrorAt("cameras.bin@8", -1));
  EXPECT_THAT(camera_errors({1, 99, "MYSTERY", 8, 8, {1}})[1], ErrorAt("cameras.txt:3", "MYSTERY"));
}

TEST(Colmap, ReadsFisheyes) {
  ColmapFixture model;
  model.cameras = {{1, 5, "OPENCV_FISHEYE", 8, 6, {10, 9, 4, 3, 0.1, 0.2, 0.3, 0.4}},
                   {2, 8, "SIMPLE_RADIAL_FISHEYE", 8, 6, {10, 4, 3, 0.1}},
                   {3, 9, "RADIAL_FISHEYE", 8, 6, {10, 4, 3, 0.1, 0.2}}};
  const auto bytes = binary_cameras(model);
  const std::string text = text_cameras(model);
  Input binary_input = input_of_bytes(bytes, "c"), text_input = input_of(text);
  for (const ColmapCameras& cameras :
       {read_colmap_cameras_binary(binary_input), read_colmap_cameras_text(text_input)}) {
    constexpr LensModel fisheye = LensModel::fisheye;
    EXPECT_EQ(cameras.at(1).lens,
              (Lens{.model = fisheye, .k1 = 0.1, .k2 = 0.2, .k3 = 0.3, .k4 = 0.4}));
    EXPECT_EQ(cameras.at(1).pinhole.fy, 9);
    EXPECT_EQ(cameras.at(1).pinhole.cy, 3);
    EXPECT_EQ(cameras.at(2).lens, (Lens{.model = fisheye, .k1 = 0.1}));
    EXPECT_EQ(cameras.at(2).pinhole.fy, 10);
    EXPECT_EQ(cameras.at(3).lens, (Lens{.model = fisheye, .k1 = 0.1, .k2 = 0.2}));
  }
}

TEST(Colmap, RefusesBadCameras) {
  for (const auto& error : camera_errors({1, 0, "SIMPLE_PINHOLE", 0, 8, {1, 1, 1}}))
    EXPECT_THAT(error, Names(0, 65536));
  for (const auto& error : camera_errors({1, 0, "SIMPLE_PINHOLE", 8, 70000, {1, 1, 1}}))
    EXPECT_THAT(error, Names(70000));
  for (const auto& error : camera_errors({1, 1, "PINHOLE", 8, 8, {1, -1, 1, 1}}))
    EXPECT_NE(error, std::nullopt);
  for (const auto& error : camera_errors({1, 1, "PINHOLE", 8, 8, {1, 1, INFINITY, 1}}))
    EXPECT_NE(error, std::nullopt);

  ColmapFixture twice = upright_colmap(1);
  twice.cameras.push_back(twice.cameras[0]);
  const auto bytes = binary_cameras(twice);
  const std::string text = text_cameras(twice);
  Input binary_input = input_of_bytes(bytes, "c"), text_input = input_of(text);
  EXPECT_THAT(error_of([&] { read_colmap_cameras_binary(binary_input); }), Names(1));
  EXPECT_THAT(error_of([&] { read_colmap_cameras_text(text_input); }), ErrorAt("test.file:4", 1));
}

std::array<std::optional<Refusal>, 2> image_errors(const ColmapFixture::ImageRecord& image) {
  ColmapFixture model;
  model.images = {image};
  const auto bytes = binary_images(model);
  const std::string text = text_images(model);
  Input binary_input = input_of_bytes(bytes, "images.bin");
  Input text_input = input_of(text, "images.txt");
  return {error_of([&] { read_colmap_images_binary(binary_input); }),
          error_of([&] { read_colmap_images_text(text_input); })};
}

TEST(Colmap, RefusesPosesThatAreNoRotations) {
  for (const auto& image : {ColmapFixture::ImageRecord{1, {1, 0.1, 0, 0}, {}, 1, "a", 0},
                            ColmapFixture::ImageRecord{1, {0, 0, 0, 0}, {}, 1, "a", 0},
                            ColmapFixture::ImageRecord{1, {NAN, 0, 0, 0}, {}, 1, "a", 0}}) {
    const auto errors = image_errors(image);
    EXPECT_THAT(errors[0], ErrorAt("images.bin@8"));
    EXPECT_THAT(errors[1], ErrorAt("images.txt:3"));
  }
  for (const auto& error : image_errors({1, {1, 0, 0, 0}, {0, INFINITY, 0}, 1, "a", 0}))
    EXPECT_NE(error, std::nullopt);
  // Six digits are precise enough.
  for (const auto& error : image_errors({1, {0.707107, 0.707107, 0, 0}, {}, 1, "a", 0}))
    EXPECT_EQ(error, std::nullopt);
}

TEST(Colmap, RefusesBadPoints) {
  ColmapFixture model = upright_colmap(1);
  model.points[0].position[1] = NAN;
  const auto bytes = binary_points(model);
  const std::string text = text_points(model);
  Input binary_input = input_of_bytes(bytes, "points3D.bin"), text_input = input_of(text);
  EXPECT_THAT(error_of([&] { read_colmap_points_binary(binary_input); }),
              ErrorAt("points3D.bin@8"));
  EXPECT_THAT(error_of([&] { read_colmap_points_text(text_input); }), ErrorAt("test.file:3"));
  const auto text_error = [](const std::string& line) {
    Input input = input_of(line);
    return error_of([&] { read_colmap_points_text(input); });
  };
  EXPECT_THAT(text_error("1 0 0 0 300 0 0 1"), ErrorIn("test.file", 300, 255));
  EXPECT_THAT(text_error("1 0 zero 0"), ErrorIn("test.file", "zero"));
  EXPECT_THAT(text_error("1 0 0x1 0"), ErrorIn("test.file", "0x1"));
  EXPECT_THAT(text_error("1 0"), ErrorAt("test.file:1"));
}

TEST(Colmap, ChecksCountsAgainstTheBytes) {
  LittleEndian huge;
  huge << (std::uint64_t(1) << 60);
  const auto bytes = huge.take();
  const std::function<void(Input&)> readers[] = {
      [](Input& input) { read_colmap_cameras_binary(input); },
      [](Input& input) { read_colmap_images_binary(input); },
      [](Input& input) { read_colmap_points_binary(input); }};
  for (const auto& read : readers) {
    Input input = input_of_bytes(bytes, "x.bin");
    EXPECT_THAT(error_of([&] { read(input); }), ErrorAt("x.bin@0", "1152921504606846976"));
  }
  auto trailing = binary_cameras(varied());
  trailing.resize(trailing.size() + 3);
  Input input = input_of_bytes(trailing, "x.bin");
  EXPECT_THAT(error_of([&] { read_colmap_cameras_binary(input); }), ErrorIn("x.bin", 3, "cameras"));
}

TEST(Colmap, RefusesAnImageOfNoCamera) {
  const TemporaryFolder folder;
  ColmapFixture model = upright_colmap(1);
  model.images[0].camera = 5;
  write_binary(folder / "", model);
  EXPECT_THAT(error_of([&] { read_colmap(folder / ""); }), ErrorIn("images.bin", "a.png", 5));
  std::filesystem::remove(folder / "images.bin");
  EXPECT_THAT(error_of([&] { read_colmap(folder / ""); }), ErrorIn("images.txt"));
}

// ---- Damage ---------------------------------------------------------------------------------

using Read = std::function<void(std::span<const std::byte>)>;

template <class Reader>
Read reading(Reader reader) {
  return [reader](std::span<const std::byte> bytes) {
    Input input = input_of_bytes(bytes, "damaged");
    reader(input);
  };
}

TEST(Colmap, SurvivesTruncationAndDamage) {
  const std::pair<std::vector<std::byte>, Read> files[] = {
      {binary_cameras(varied()), reading(read_colmap_cameras_binary)},
      {binary_images(varied()), reading(read_colmap_images_binary)},
      {binary_points(varied()), reading(read_colmap_points_binary)}};
  for (const auto& [bytes, read] : files) {
    EXPECT_NO_THROW(read(bytes));
    EXPECT_EQ(survive_truncation(bytes, read).read, 0u);
    EXPECT_GT(survive_damage(bytes, read).refused, 0u);
  }
}

TEST(Colmap, TextSurvivesTruncationAndDamage) {
  const std::pair<std::string, Read> files[] = {
      {text_cameras(varied()), reading(read_colmap_cameras_text)},
      {text_images(varied()), reading(read_colmap_images_text)},
      {text_points(varied()), reading(read_colmap_points_text)}};
  for (const auto& [text, read] : files) {
    const auto bytes = std::as_bytes(std::span(text));
    EXPECT_NO_THROW(read(bytes));
    // A text may end between two records.
    EXPECT_GT(survive_truncation(bytes, read).refused, 0u);
    EXPECT_GT(survive_damage(bytes, read).refused, 0u);
  }
}

TEST(Colmap, SurvivesRandomDamage) {
  const std::pair<std::vector<std::byte>, Read> files[] = {
      {binary_cameras(varied()), reading(read_colmap_cameras_binary)},
      {binary_images(varied()), reading(read_colmap_images_binary)},
      {binary_points(varied()), reading(read_colmap_points_binary)}};
  const unsigned seed = 11;
  SCOPED_TRACE(::testing::Message() << "seed " << seed);
  std::mt19937 random(seed);
  Survival survival;
  for (int run = 0; run < 20000; ++run) {
    const auto& [bytes, read] = files[random() % 3];
    std::vector<std::byte> damaged = bytes;
    // Zero and all-ones bytes are more likely, because counts and sizes are sensitive to them.
    for (unsigned flips = 1 + random() % 6; flips > 0; --flips) {
      const unsigned kind = random() % 4;
      damaged[random() % damaged.size()] = std::byte(kind == 0   ? 0u
                                                     : kind == 1 ? 0xffu
                                                                 : random() & 0xffu);
    }
    if (random() % 4 == 0) damaged.resize(random() % damaged.size());
    expect_survival(damaged, read, "run " + std::to_string(run), survival);
  }
  EXPECT_GT(survival.read, 0u);
  EXPECT_GT(survival.refused, 0u);
}

}  // namespace colmap_test
}  // namespace tureen
