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
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

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
  expect(9, {502, 502, 320, 240}, brown({.k1 = 0.125}));
  expect(4, {503, 503, 320, 240}, brown({.k1 = 0.125, .k2 = -0.0625}));
  expect(70000, {504, 505, 320, 240}, brown({.k1 = 0.1, .k2 = 0.2, .p1 = 0.3, .p2 = 0.4}));
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
  ASSERT_EQ(a.points.points.size(), 2u);
  ASSERT_EQ(b.points.points.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(a.points.points[i].position, b.points.points[i].position);
    EXPECT_EQ(a.points.points[i].color, b.points.points[i].color);
  }
  EXPECT_EQ(a.points.points[1].position, glm::dvec3(-1e9, 1e-9, 2.0 / 3));
  EXPECT_EQ(a.points.points[1].color, glm::u8vec3(255, 0, 128));
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

// Some programs leave out the lines of features. Without a check, every second image would be read
// as the features of the previous one.
TEST(Colmap, ReadsImagesWithoutTheirFeatures) {
  const std::string text =
      "1 1 0 0 0 0 0 1 1 a.jpg\n2 1 0 0 0 0 0 2 1 b c.jpg\n3 1 0 0 0 0 0 3 1 d.jpg\n\n"
      "4 1 0 0 0 0 0 4 1 e.jpg\n1 2 -1 3 4 5\n5 1 0 0 0 0 0 5 1 f.jpg";
  Input input = input_of(text, "images.txt");
  const std::vector<ColmapImage> images = read_colmap_images_text(input);
  ASSERT_EQ(images.size(), 5u);
  EXPECT_EQ(images[1].name, "b c.jpg");
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(images[i].view_from_world[3][2], -double(i + 1));
  const std::string other = "1 1 0 0 0 0 0 1 1 a.jpg\n2 1 0 0 zero 0 0 1 1 b.jpg\n";
  Input wrong = input_of(other, "images.txt");
  EXPECT_THAT(error_of([&] { read_colmap_images_text(wrong); }), ErrorAt("images.txt:2", "a.jpg"));
}

TEST(Colmap, ReadsWhatEditorsWrite) {
  const std::string text = "\xef\xbb\xbf# images\r\n1 1 0 0 0 0 0 1 1 a  b .jpg\r\n\r\n";
  Input input = input_of(text, "images.txt");
  const std::vector<ColmapImage> images = read_colmap_images_text(input);
  ASSERT_EQ(images.size(), 1u);
  EXPECT_EQ(images[0].name, "a  b .jpg");
}

TEST(Colmap, FindsItsFolders) {
  const TemporaryFolder folder;
  const auto found = [&] {
    std::vector<std::string> names;
    for (const auto& path : colmap_folders(folder / ""))
      names.push_back(path.lexically_relative(folder / "").string());
    return names;
  };
  EXPECT_THAT(found(), IsEmpty());
  write_text(folder / "cameras.txt", "");
  write_text(folder / "images.txt", "");
  EXPECT_THAT(found(), ElementsAre("."));
  write_text(folder / "colmap/sparse/0/cameras.txt", "");
  EXPECT_THAT(found(), ElementsAre("colmap/sparse/0"));
  write_text(folder / "sparse/cameras.bin", "");
  EXPECT_THAT(found(), ElementsAre("sparse"));
  for (const char* number : {"10", "0", "2", "x1"})
    write_text(folder / ("sparse/" + std::string(number) + "/cameras.bin"), "");
  EXPECT_THAT(found(), ElementsAre("sparse/0", "sparse/2", "sparse/10"));
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

/// The camera in both forms.
std::array<ColmapCamera, 2> cameras_of(const ColmapFixture::CameraRecord& camera) {
  ColmapFixture model;
  model.cameras = {camera};
  const auto bytes = binary_cameras(model);
  const std::string text = text_cameras(model);
  Input binary_input = input_of_bytes(bytes, "cameras.bin");
  Input text_input = input_of(text, "cameras.txt");
  return {read_colmap_cameras_binary(binary_input).at(camera.number),
          read_colmap_cameras_text(text_input).at(camera.number)};
}

TEST(Colmap, NamesModelsThatItDoesNotSupport) {
  // The number of parameters of an unknown number is unknown, too.
  EXPECT_THAT(camera_errors({1, 99, "MYSTERY", 8, 8, {1}})[0], ErrorAt("cameras.bin@8", 99));
  EXPECT_THAT(camera_errors({1, -1, "MYSTERY", 8, 8, {1}})[0], ErrorAt("cameras.bin@8", -1));
  const std::string text = "1 MYSTERY 8 8 1 2 3\n2 PINHOLE 8 6 1 1 4 3\n";
  Input input = input_of(text, "cameras.txt");
  const ColmapCameras cameras = read_colmap_cameras_text(input);
  EXPECT_THAT(cameras.at(1).defect, AllOf(HasSubstr("MYSTERY"), HasSubstr("FULL_OPENCV"),
                                          HasSubstr("image_undistorter")));
  EXPECT_EQ(cameras.at(2).defect, "");
}

TEST(Colmap, ReadsEveryLens) {
  const std::vector<double> numbers{0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1, 1.1, 1.2};
  const struct {
    int number;
    const char* name;
    std::size_t focal_lengths, coefficients;
    const LensModel* model;
  } models[] = {{5, "OPENCV_FISHEYE", 2, 4, &fisheye_model},
                {6, "FULL_OPENCV", 2, 8, &brown_model},
                {7, "FOV", 2, 1, &fov_model},
                {8, "SIMPLE_RADIAL_FISHEYE", 1, 1, &fisheye_model},
                {9, "RADIAL_FISHEYE", 1, 2, &fisheye_model},
                {10, "THIN_PRISM_FISHEYE", 2, 8, &thin_prism_model},
                {11, "RAD_TAN_THIN_PRISM_FISHEYE", 2, 12, &rad_tan_thin_prism_model},
                {12, "SIMPLE_DIVISION", 1, 1, &division_model},
                {13, "DIVISION", 2, 1, &division_model},
                {14, "SIMPLE_FISHEYE", 1, 0, &fisheye_model},
                {15, "FISHEYE", 2, 0, &fisheye_model},
                {16, "EUCM", 2, 2, &eucm_model}};
  for (const auto& [number, name, focal_lengths, coefficients, model] : models) {
    ColmapFixture::CameraRecord record{1, number, name, 8, 6, {10}};
    if (focal_lengths == 2) record.parameters.push_back(9);
    record.parameters.insert(record.parameters.end(), {4, 3});
    record.parameters.insert(record.parameters.end(), numbers.begin(),
                             numbers.begin() + std::ptrdiff_t(coefficients));
    for (const ColmapCamera& camera : cameras_of(record)) {
      EXPECT_EQ(camera.defect, "") << name;
      EXPECT_EQ(camera.pinhole.fy, focal_lengths == 2 ? 9 : 10) << name;
      EXPECT_EQ(camera.pinhole.cy, 3) << name;
      EXPECT_EQ(camera.lens, lens_of(*model, std::span(numbers).first(coefficients))) << name;
    }
    // All zeros: a pinhole, or the plain fisheye.
    std::fill(record.parameters.begin() + std::ptrdiff_t(focal_lengths + 2),
              record.parameters.end(), 0.0);
    for (const ColmapCamera& camera : cameras_of(record))
      EXPECT_EQ(camera.lens.is_pinhole(), !model->is_fisheye) << name;
  }
}

TEST(Colmap, NamesWhatIsWrongWithACamera) {
  for (const auto& camera : cameras_of({1, 0, "SIMPLE_PINHOLE", 0, 8, {1, 1, 1}}))
    EXPECT_THAT(camera.defect, AllOf(HasSubstr("0"), HasSubstr("65536")));
  for (const auto& camera : cameras_of({1, 0, "SIMPLE_PINHOLE", 8, 70000, {1, 1, 1}}))
    EXPECT_THAT(camera.defect, HasSubstr("70000"));
  for (const auto& camera : cameras_of({1, 1, "PINHOLE", 8, 8, {1, -1, 1, 1}}))
    EXPECT_THAT(camera.defect, HasSubstr("focal length"));
  for (const auto& camera : cameras_of({1, 1, "PINHOLE", 8, 8, {1, 1, INFINITY, 1}}))
    EXPECT_THAT(camera.defect, HasSubstr("finite"));
}

TEST(Colmap, RefusesACameraThatOccursTwice) {
  ColmapFixture twice = upright_colmap(1);
  twice.cameras.push_back(twice.cameras[0]);
  const auto bytes = binary_cameras(twice);
  const std::string text = text_cameras(twice);
  Input binary_input = input_of_bytes(bytes, "c"), text_input = input_of(text);
  EXPECT_THAT(error_of([&] { read_colmap_cameras_binary(binary_input); }), Names(1));
  EXPECT_THAT(error_of([&] { read_colmap_cameras_text(text_input); }), ErrorAt("test.file:4", 1));
}

/// The image in both forms.
std::array<ColmapImage, 2> images_of(const ColmapFixture::ImageRecord& image) {
  ColmapFixture model;
  model.images = {image};
  const auto bytes = binary_images(model);
  const std::string text = text_images(model);
  Input binary_input = input_of_bytes(bytes, "images.bin");
  Input text_input = input_of(text, "images.txt");
  return {read_colmap_images_binary(binary_input).at(0), read_colmap_images_text(text_input).at(0)};
}

TEST(Colmap, NamesWhatIsWrongWithAPose) {
  for (const auto& image : {ColmapFixture::ImageRecord{1, {1, 0.1, 0, 0}, {}, 1, "a", 0},
                            ColmapFixture::ImageRecord{1, {0, 0, 0, 0}, {}, 1, "a", 0}})
    for (const ColmapImage& read : images_of(image))
      EXPECT_THAT(read.defect, HasSubstr("not a rotation"));
  for (const auto& image :
       {ColmapFixture::ImageRecord{1, {NAN, 0, 0, 0}, {}, 1, "a", 0},
        ColmapFixture::ImageRecord{1, {1, 0, 0, 0}, {0, INFINITY, 0}, 1, "a", 0}})
    for (const ColmapImage& read : images_of(image))
      EXPECT_THAT(read.defect, HasSubstr("not finite"));
  // Six digits are precise enough.
  for (const ColmapImage& read : images_of({1, {0.707107, 0.707107, 0, 0}, {}, 1, "a", 0}))
    EXPECT_EQ(read.defect, "");
}

TEST(Colmap, SkipsPointsThatAreDamagedOrNotFinite) {
  ColmapFixture model = upright_colmap(1);
  model.points[0].position[1] = NAN;
  const auto bytes = binary_points(model);
  const std::string text = text_points(model);
  Input binary_input = input_of_bytes(bytes, "points3D.bin"), text_input = input_of(text);
  for (const ColmapPoints& read :
       {read_colmap_points_binary(binary_input), read_colmap_points_text(text_input)}) {
    EXPECT_EQ(read.skipped, 1u);
    EXPECT_EQ(read.points.size(), model.points.size() - 1);
  }
  for (const char* damaged : {"1 0 0 0 300 0 0 1", "1 0 zero 0", "1 0 0x1 0", "1 0"}) {
    const std::string lines = std::string(damaged) + "\n2 4 5 6 7 8 9 0\n";
    Input input = input_of(lines);
    const ColmapPoints read = read_colmap_points_text(input);
    EXPECT_EQ(read.skipped, 1u) << damaged;
    ASSERT_EQ(read.points.size(), 1u) << damaged;
    EXPECT_EQ(read.points[0].position, glm::dvec3(4, 5, 6));
  }
}

TEST(Colmap, ChecksCountsAgainstTheBytes) {
  LittleEndian huge;
  huge << (std::uint64_t(1) << 60);
  const auto bytes = huge.take();
  const std::function<void(Input&)> readers[] = {
      [](Input& input) { read_colmap_cameras_binary(input); },
      [](Input& input) { read_colmap_images_binary(input); },
      [](Input& input) { read_colmap_points_binary(input); },
      [](Input& input) { read_colmap_tracks_binary(input); }};
  for (const auto& read : readers) {
    Input input = input_of_bytes(bytes, "x.bin");
    EXPECT_THAT(error_of([&] { read(input); }), ErrorAt("x.bin@0", "1152921504606846976"));
  }
  auto trailing = binary_cameras(varied());
  trailing.resize(trailing.size() + 3);
  Input input = input_of_bytes(trailing, "x.bin");
  EXPECT_THAT(error_of([&] { read_colmap_cameras_binary(input); }), ErrorIn("x.bin", 3, "cameras"));
}

TEST(Colmap, NamesTheCameraThatAnImageLacks) {
  const TemporaryFolder folder;
  ColmapFixture model = upright_colmap(1);
  model.images[0].camera = 5;
  write_binary(folder / "", model);
  EXPECT_EQ(read_colmap(folder / "").images[0].defect, "its camera 5 is missing");
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
      {binary_points(varied()), reading(read_colmap_points_binary)},
      {binary_points(varied()), reading(read_colmap_tracks_binary)}};
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
    // A text may end between two records; damaged points are skipped.
    const bool skips = &text == &files[2].first;
    EXPECT_EQ(survive_truncation(bytes, read).refused > 0, !skips);
    EXPECT_EQ(survive_damage(bytes, read).refused > 0, !skips);
  }
}

TEST(Colmap, SurvivesRandomDamage) {
  const std::pair<std::vector<std::byte>, Read> files[] = {
      {binary_cameras(varied()), reading(read_colmap_cameras_binary)},
      {binary_images(varied()), reading(read_colmap_images_binary)},
      {binary_points(varied()), reading(read_colmap_points_binary)},
      {binary_points(varied()), reading(read_colmap_tracks_binary)}};
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
