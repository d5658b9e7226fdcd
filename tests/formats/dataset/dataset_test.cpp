// Datasets of every kind: folders that the tests write, and what the reader makes of them. The file
// exceeds 600 lines: all kinds share one fixture, and must give the same photographs.
#include "formats/dataset/dataset.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include "base/memory_budget.hpp"
#include "formats/dataset/dataset_remarks.hpp"
#include "image/box_scale.hpp"
#include "tests/formats/dataset/dataset_fixture.hpp"
#include "tests/formats/format_testing.hpp"
#include "tests/formats/truncation.hpp"

namespace tureen {
namespace dataset_test {

using namespace tureen::test;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::Not;

std::vector<std::string> names(const std::vector<Photograph>& photographs) {
  std::vector<std::string> result;
  for (const Photograph& photograph : photographs) result.push_back(photograph.camera.name);
  return result;
}

/// A frame of transforms.json at (x, 2, 3), along +y, z up. `extra` are further members.
std::string frame(const std::string& file_path, int x = 1, const std::string& extra = "") {
  return "{\"file_path\": \"" + file_path + "\", " + extra + "\"transform_matrix\": [[1,0,0," +
         std::to_string(x) + "],[0,0,-1,2],[0,1,0,3],[0,0,0,1]]}";
}

std::string transforms(const std::string& head, const std::vector<std::string>& frames) {
  std::string list;
  for (const std::string& one : frames) list += (list.empty() ? "" : ", ") + one;
  return "{" + head + "\"frames\": [" + list + "]}";
}

const char* const intrinsics = "\"fl_x\": 10, \"fl_y\": 9, \"cx\": 4.5, \"cy\": 2.5, ";

/// Writes images/0.png .. of 8 x 6 pixels, and their transforms.json.
void write_transforms(const TemporaryFolder& folder, int count, const std::string& head = "") {
  std::vector<std::string> frames;
  for (int i = 0; i < count; ++i) {
    frames.push_back(frame("images/" + std::to_string(i) + ".png", i));
    write_image(folder / ("images/" + std::to_string(i) + ".png"), an_image(8, 6, i));
  }
  // The frames are not in name order.
  std::reverse(frames.begin(), frames.end());
  write_text(folder / "transforms.json",
             transforms(intrinsics + std::string("\"w\": 8, \"h\": 6.0, ") + head, frames));
}

void write_colmap(const TemporaryFolder& folder, int count) {
  const ColmapFixture model = upright_colmap(count);
  write_binary(folder / "sparse/0", model);
  for (int i = 0; i < count; ++i)
    write_image(folder / ("images/" + model.images[std::size_t(i)].name), an_image(8, 6, i));
}

/// The error if no photograph may be skipped.
std::optional<Refusal> refusal(const std::filesystem::path& path, DatasetOptions options = {}) {
  options.is_strict = true;
  return error_of([&] { read_dataset(path, options); });
}

// ---- Memory -----------------------------------------------------------------------------------

struct SmallMemory {
  explicit SmallMemory(std::uint64_t bytes) { set_max_memory(bytes); }
  ~SmallMemory() { set_max_memory(default_max_memory); }
};

TEST(Dataset, HoldsPhotographsBeyondHalfOfTheMemoryInAFile) {
  const TemporaryFolder folder;
  std::vector<std::string> frames;
  for (int i = 0; i < 9; ++i) {
    Image8 image = an_image(640, 480, i);
    if (i < 8)  // the last one has no transparent pixels
      for (int x = 0; x < 640; ++x) image.at(x, 7).a = 0;
    frames.push_back(frame("images/" + std::to_string(i) + ".png", i));
    write_image(folder / ("images/" + std::to_string(i) + ".png"), image);
  }
  for (const char* size : {"", "\"w\": 640, \"h\": 480, "}) {
    write_text(folder / "transforms.json", transforms(intrinsics + std::string(size), frames));
    for (const AlphaMeaning meaning : {AlphaMeaning::mask, AlphaMeaning::background}) {
      const Dataset whole = read_dataset(folder / "", {.alpha = meaning});
      // Half of it holds three of these photographs.
      const SmallMemory limit(8 << 20);
      const Dataset small = read_dataset(folder / "", {.alpha = meaning});
      std::size_t in_file = 0;
      for (const auto part : {&Dataset::train, &Dataset::test})
        for (std::size_t i = 0; i < (whole.*part).size(); ++i) {
          const Photograph &expected = (whole.*part)[i], &found = (small.*part)[i];
          EXPECT_EQ(expected.file(), nullptr);
          in_file += found.file() != nullptr;
          EXPECT_EQ(found.image().pixels, expected.image().pixels);
          EXPECT_EQ(found.ignored(), expected.ignored());
        }
      EXPECT_EQ(in_file, 6u);
    }
  }
}

// ---- Reading --------------------------------------------------------------------------------

TEST(Dataset, ReadsTransformsInNameOrderWithEveryEighthForTesting) {
  const TemporaryFolder folder;
  write_transforms(folder, 10);
  const Dataset dataset = read_dataset(folder / "");
  EXPECT_THAT(names(dataset.test), ElementsAre("images/0.png", "images/8.png"));
  EXPECT_THAT(names(dataset.train),
              ElementsAre("images/1.png", "images/2.png", "images/3.png", "images/4.png",
                          "images/5.png", "images/6.png", "images/7.png", "images/9.png"));
  const Photograph& third = dataset.train[2];
  EXPECT_EQ(third.image().pixels, an_image(8, 6, 3).pixels);
  EXPECT_EQ(third.camera.width, 8);
  EXPECT_EQ(third.camera.height, 6);
  EXPECT_EQ(third.camera.fx, 10);
  EXPECT_EQ(third.camera.fy, 9);
  EXPECT_EQ(third.camera.cx, 4.5);
  EXPECT_EQ(third.camera.cy, 2.5);
  EXPECT_LT(glm::length(third.camera.eye() - glm::dvec3(3, 2, 3)), 1e-12);
  EXPECT_LT(glm::length(third.camera.world_from_view_rotation()[1] - glm::dvec3(0, 0, 1)), 1e-12);
  EXPECT_EQ(dataset.up, glm::vec3(0, 0, 1));
  EXPECT_FALSE(dataset.has_alpha);
  EXPECT_TRUE(dataset.points.empty());
  // The path of the file works like that of its folder. Another split.
  const Dataset thirds = read_dataset(folder / "transforms.json", {.test_every = 3});
  EXPECT_THAT(names(thirds.test),
              ElementsAre("images/0.png", "images/3.png", "images/6.png", "images/9.png"));
}

TEST(Dataset, ReadsAFileASplitWithoutExtensionsOrSizes) {
  const TemporaryFolder folder;
  const std::string angle = "\"camera_angle_x\": 1.5707963267948966, ";  // fx = w / 2
  write_text(
      folder / "transforms_train.json",
      transforms(angle, {frame("./train/r_2"), frame("./train/r_10"), frame("./train/r_0")}));
  write_text(folder / "transforms_test.json", transforms(angle, {frame("./test/r_0")}));
  for (const char* name : {"train/r_0", "train/r_2", "train/r_10"})
    write_image(folder / (std::string(name) + ".png"), an_image(8, 6));
  Image8 transparent = an_image(10, 4);
  transparent.at(3, 2).a = 100;
  transparent.at(4, 2) = glm::u8vec4(9, 8, 7, 0);
  write_image(folder / "test/r_0.PNG", transparent);
  const Dataset dataset = read_dataset(folder / "", {.alpha = AlphaMeaning::background});
  EXPECT_THAT(names(dataset.train), ElementsAre("./train/r_0", "./train/r_10", "./train/r_2"));
  EXPECT_THAT(names(dataset.test), ElementsAre("./test/r_0"));
  EXPECT_TRUE(dataset.has_alpha);
  EXPECT_EQ(dataset.test[0].image().pixels, transparent.pixels);  // straight alpha, unchanged
  const Camera &train = dataset.train[0].camera, &test = dataset.test[0].camera;
  EXPECT_NEAR(train.fx, 4, 1e-12);
  EXPECT_NEAR(test.fx, 5, 1e-12);
  EXPECT_EQ(test.fx, test.fy);
  EXPECT_EQ(test.cx, 5);
  EXPECT_EQ(test.cy, 2);

  const Dataset half = read_dataset(folder / "", {.part = DatasetPart::train});
  EXPECT_TRUE(half.test.empty());
  EXPECT_EQ(half.train.size(), 3u);
  EXPECT_FALSE(half.has_alpha);
}

TEST(Dataset, RefusesUnequalImagesWhereNoSizeIsGiven) {
  const TemporaryFolder folder;
  const std::string angle = "\"camera_angle_x\": 1.5707963267948966, ";
  for (const char* split : {"train", "test"})
    write_text(folder / ("transforms_" + std::string(split) + ".json"),
               transforms(angle, {frame("./" + std::string(split) + "/a"),
                                  frame("./" + std::string(split) + "/b")}));
  for (const char* name : {"train/a.png", "test/a.png", "test/b.png"})
    write_image(folder / name, an_image(8, 6));
  write_image(folder / "train/b.png", an_image(6, 6));
  EXPECT_THAT(refusal(folder / ""), ErrorIn("b.png", 6, 8));
}

TEST(Dataset, AFrameHasItsOwnIntrinsicsAndSize) {
  const TemporaryFolder folder;
  write_image(folder / "a.png", an_image(8, 6));
  write_image(folder / "b.png", an_image(5, 7));
  write_text(folder / "transforms.json",
             transforms(intrinsics + std::string("\"w\": 8, \"h\": 6, "),
                        {frame("a.png"), frame("b.png", 1, "\"w\":5, \"h\":7, \"fl_x\":20, ")}));
  const Dataset dataset = read_dataset(folder / "");
  EXPECT_EQ(dataset.test[0].camera.fx, 10);
  EXPECT_EQ(dataset.train[0].camera.fx, 20);
  EXPECT_EQ(dataset.train[0].camera.fy, 9);
  EXPECT_EQ(dataset.train[0].image().height, 7);
}

TEST(Dataset, AFrameHasItsOwnLens) {
  const TemporaryFolder folder;
  for (const char* name : {"a.png", "b.png"})
    write_image(folder / name, Image8(80, 60, glm::u8vec4(200, 100, 50, 255)));
  const auto with = [&](const std::string& head, const std::string& lens) {
    write_text(folder / "transforms.json", transforms("\"fl_x\": 70, \"w\": 80, \"h\": 60, " + head,
                                                      {frame("a.png"), frame("b.png", 1, lens)}));
    return read_dataset(folder / "");
  };
  // Barrel distortion removes columns of the photograph that has it.
  const Dataset own = with("", "\"k1\": 0.1, ");
  EXPECT_EQ(own.test[0].camera.width, 80);
  EXPECT_LT(own.train[0].camera.width, 80);
  const Dataset none = with("\"k1\": 0.1, \"camera_model\": \"OPENCV\", ",
                            "\"k1\": 0, \"camera_model\": \"PINHOLE\", ");
  EXPECT_LT(none.test[0].camera.width, 80);
  EXPECT_EQ(none.train[0].camera.width, 80);
}

TEST(Dataset, ReadsColmap) {
  const TemporaryFolder folder;
  write_colmap(folder, 9);
  const Dataset dataset = read_dataset(folder / "");
  EXPECT_THAT(names(dataset.test), ElementsAre("a.png", "i.png"));
  EXPECT_EQ(dataset.train.size(), 7u);
  const Photograph& b = dataset.train[0];
  EXPECT_EQ(b.camera.name, "b.png");
  EXPECT_EQ(b.image().pixels, an_image(8, 6, 1).pixels);
  EXPECT_EQ(b.camera.cx, 4.5);
  EXPECT_EQ(b.camera.cy, 2.5);
  EXPECT_LT(glm::length(b.camera.eye() - glm::dvec3(-0.25, -0.5, -3)), 1e-12);
  ASSERT_EQ(dataset.points.size(), 1u);
  EXPECT_EQ(dataset.points[0].position, glm::dvec3(1, 2, 3));
  // All cameras are upright, with COLMAP's y down.
  EXPECT_EQ(dataset.up, glm::vec3(0, -1, 0));
  EXPECT_THAT(dataset.remarks, ElementsAre(Remark{&remarks::up_of_cameras}));
}

TEST(Dataset, ReadsNoImageOfTheOtherPart) {
  const TemporaryFolder folder;
  write_colmap(folder, 9);
  std::filesystem::remove(folder / "images/a.png");
  std::vector<double> fractions;
  const Dataset dataset = read_dataset(
      folder / "",
      {.part = DatasetPart::train, .progress = [&](double f) { fractions.push_back(f); }});
  EXPECT_EQ(dataset.train.size(), 7u);
  EXPECT_TRUE(dataset.test.empty());
  ASSERT_GE(fractions.size(), 2u);
  EXPECT_EQ(fractions.front(), 0.0);
  EXPECT_EQ(fractions.back(), 1.0);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
}

TEST(Dataset, ProgressMayAbandonTheRead) {
  const TemporaryFolder folder;
  write_colmap(folder, 3);
  struct Abandoned {};
  EXPECT_THROW(read_dataset(folder / "", {.progress =
                                              [](double f) {
                                                if (f > 0.5) throw Abandoned();
                                              }}),
               Abandoned);
}

// ---- Scale, other folders of images, distortion ---------------------------------------------

TEST(Dataset, IntrinsicsFollowTheScaleExactly) {
  const TemporaryFolder folder;
  write_colmap(folder, 2);
  const Dataset dataset = read_dataset(folder / "", {.scale = 0.5});
  const Photograph& half = dataset.train[0];
  EXPECT_EQ(half.camera.width, 4);
  EXPECT_EQ(half.camera.height, 3);
  EXPECT_EQ(half.camera.fx, 5);
  EXPECT_EQ(half.camera.fy, 4.5);
  EXPECT_EQ(half.camera.cx, 2.25);  // relative to the corner, which does not move
  EXPECT_EQ(half.camera.cy, 1.25);
  EXPECT_EQ(half.image().pixels, box_scaled(an_image(8, 6, 1), 4, 3).pixels);
  // 8 x 0.3 = 2.4 and 6 x 0.3 = 1.8 are rounded; the camera uses the rounded sizes.
  const Camera odd = read_dataset(folder / "", {.scale = 0.3}).train[0].camera;
  EXPECT_EQ(odd.width, 2);
  EXPECT_EQ(odd.height, 2);
  EXPECT_NEAR(odd.fx, 10 * 2.0 / 8, 1e-15);
  EXPECT_NEAR(odd.cy, 2.5 * 2.0 / 6, 1e-15);
}

TEST(Dataset, ReadsSmallerImagesFromTheirFolder) {
  const TemporaryFolder folder;
  write_colmap(folder, 2);
  // 8 x 6 divided by 4 is 2 x 1.5: one image rounds down, the other up, with another extension.
  write_image(folder / "images_4/a.png", an_image(2, 1));
  write_image(folder / "images_4/b.JPG", an_image(2, 2, 5));
  const Dataset dataset = read_dataset(folder / "", {.images_folder = 4});
  EXPECT_EQ(dataset.test[0].camera.fx, 2.5);
  EXPECT_NEAR(dataset.test[0].camera.fy, 9.0 / 6, 1e-15);
  EXPECT_NEAR(dataset.train[0].camera.fy, 18.0 / 6, 1e-15);
  EXPECT_EQ(dataset.train[0].image().pixels, an_image(2, 2, 5).pixels);

  write_transforms(folder, 2);
  write_image(folder / "images_2/0.png", an_image(4, 3));
  write_image(folder / "images_2/1.png", an_image(4, 3, 9));
  const Photograph photograph = read_dataset(folder / "", {.images_folder = 2}).train[0];
  EXPECT_EQ(photograph.image().pixels, an_image(4, 3, 9).pixels);
  EXPECT_EQ(photograph.camera.fx, 5);
  EXPECT_EQ(photograph.camera.cx, 2.25);
  write_image(folder / "images_2/1.png", an_image(5, 3));
  EXPECT_THAT(refusal(folder / "", {.images_folder = 2}), Names(5, 3, 8, 6, 2));
}

TEST(Dataset, WithoutDistortedBordersEveryPixelIsEvidence) {
  const TemporaryFolder folder;
  for (const char* name : {"images/0.png", "images/1.png"})
    write_image(folder / name, Image8(80, 60, glm::u8vec4(200, 100, 50, 255)));
  write_text(folder / "transforms.json",
             transforms("\"fl_x\": 70, \"cx\": 38, \"k1\": 0.1, \"w\": 80, \"h\": 60, ",
                        {frame("images/0.png"), frame("images/1.png")}));
  const Dataset whole = read_dataset(folder / "");
  const Photograph& photograph = whole.train[0];
  EXPECT_FALSE(whole.has_alpha);
  EXPECT_THAT(whole.remarks,
              ::testing::Contains(::testing::Field(&Remark::kind, &remarks::lens_undone_cropped)));
  for (const glm::u8vec4& pixel : photograph.image().pixels)
    ASSERT_EQ(pixel, glm::u8vec4(200, 100, 50, 255));
  // At the left edge, 38 pixels from the axis, r^2 = 0.295: 3 % or 1.1 pixels are missing. At the
  // right edge, r^2 = 0.36 gives 1.5 pixels; at the corners it is slightly more.
  EXPECT_EQ(photograph.camera.fx, 70);
  EXPECT_EQ(photograph.camera.fy, 70);
  const double left = 38 - photograph.camera.cx;
  EXPECT_GE(left, 2);
  EXPECT_LE(left, 4);
  EXPECT_LE(photograph.camera.width, 76);
  EXPECT_GE(photograph.camera.width, 71);
  EXPECT_EQ(photograph.camera.width, photograph.image().width);
  EXPECT_EQ(photograph.camera.height, photograph.image().height);

  const Photograph half = read_dataset(folder / "", {.scale = 0.5}).train[0];
  EXPECT_EQ(half.camera.fx, 35);
  EXPECT_EQ(19 - half.camera.cx, std::ceil(left / 2));
  for (const glm::u8vec4& pixel : half.image().pixels)
    ASSERT_EQ(pixel, glm::u8vec4(200, 100, 50, 255));
}

TEST(Dataset, FisheyesBecomePinholes) {
  const TemporaryFolder folder;
  // A photograph of 80 pixels for 160 degrees, in which each pixel has its angle to the left or
  // right of the axis as its colour.
  Image8 photograph(80, 60);
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 80; ++x)
      photograph.at(x, y) = glm::u8vec4(glm::u8(128 + (x + 0.5 - 40) * 2), 0, 0, 255);
  for (const char* name : {"images/0.png", "images/1.png"}) write_image(folder / name, photograph);
  const double focal = 40 / glm::radians(80.0);
  for (const char* lens : {"\"is_fisheye\": true, ", "\"camera_model\": \"OPENCV_FISHEYE\", "}) {
    write_text(folder / "transforms.json",
               transforms(lens + ("\"fl_x\": " + std::to_string(focal)) + ", \"k4\": 0.0, ",
                          {frame("images/0.png"), frame("images/1.png")}));
    const Dataset dataset = read_dataset(folder / "");
    const Photograph& pinhole = dataset.train[0];
    ASSERT_EQ(pinhole.camera.width, 80);
    for (const int x : {5, 20, 40, 60, 75}) {
      const double angle = std::atan((x + 0.5 - 40) / pinhole.camera.fx);
      EXPECT_NEAR(pinhole.image().at(x, 30).r, 128 + angle * focal * 2, 1.0) << x;
    }
    const double degrees = glm::degrees(2 * std::atan(40 / focal));
    ASSERT_EQ(dataset.remarks.size(), 3u);
    EXPECT_EQ(dataset.remarks[2].kind, &remarks::fisheye_undone);
    EXPECT_NEAR(std::get<double>(dataset.remarks[2].fields[0].value), degrees, 1e-3);
  }
  std::filesystem::remove(folder / "transforms.json");
  ColmapFixture model = upright_colmap(2);
  model.cameras[0] = {1, 5, "OPENCV_FISHEYE", 8, 6, {10, 9, 4, 3, 0, 0, 0, 0}};
  write_text(folder / "sparse/0", model);
  for (const auto& image : model.images)
    write_image(folder / ("images/" + image.name), an_image(8, 6));
  EXPECT_EQ(read_dataset(folder / "").remarks.back().kind, &remarks::fisheye_undone);
}

// ---- Nerfstudio -----------------------------------------------------------------------------

const char* const cloud =
    "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
    "property float z\nproperty uint8 red\nproperty uint8 green\nproperty uint8 blue\n"
    "end_header\n0.5 -1 2 255 128 0\n1 2 3 4 5 6\n";

TEST(Dataset, ReadsThePointsOfNerfstudio) {
  const TemporaryFolder folder;
  const std::string applied = "\"applied_transform\": [[1,0,0,0],[0,0,1,0.5],[0,-1,0,0]], ";
  write_transforms(folder, 2, applied + "\"ply_file_path\": \"sparse_pc.ply\", ");
  // The file of points is in the frames' coordinates already, so nothing is applied.
  write_text(folder / "sparse_pc.ply", cloud);
  Dataset dataset = read_dataset(folder / "");
  ASSERT_EQ(dataset.points.size(), 2u);
  EXPECT_EQ(dataset.points[0].position, glm::dvec3(0.5, -1, 2));
  EXPECT_EQ(dataset.points[0].color, glm::u8vec3(255, 128, 0));
  EXPECT_THAT(dataset.remarks, ElementsAre(Remark{&remarks::up_of_transforms}));

  std::filesystem::remove(folder / "sparse_pc.ply");
  dataset = read_dataset(folder / "");
  EXPECT_TRUE(dataset.points.empty());
  EXPECT_THAT(dataset.remarks,
              ::testing::Contains(Remark{&remarks::points_missing, {{"file", "sparse_pc.ply"}}}));
  // COLMAP's points (1, 2, 3) are in its own coordinates.
  write_transforms(folder, 2, applied);
  write_binary(folder / "colmap/sparse/0", upright_colmap(2));
  dataset = read_dataset(folder / "");
  ASSERT_EQ(dataset.points.size(), 1u);
  EXPECT_EQ(dataset.points[0].position, glm::dvec3(1, 3.5, -2));
  write_transforms(folder, 2, "\"applied_transform\": [[1e308,0,0,1e308],[0,0,1,0],[0,-1,0,0]], ");
  EXPECT_THAT(refusal(folder / ""), ErrorIn("transforms.json", "applied_transform", "infinity"));
  // Without the matrix, their place is unknown.
  write_transforms(folder, 2);
  EXPECT_TRUE(read_dataset(folder / "").points.empty());
  write_transforms(folder, 2, "\"applied_transform\": [[1,0],[0,0,1,0],[0,-1,0,0]], ");
  EXPECT_THAT(refusal(folder / ""), ErrorIn("transforms.json", "applied_transform"));
  // An absolute path counts where it exists.
  write_text(folder / "apart/points.ply", cloud);
  write_transforms(folder, 2,
                   "\"ply_file_path\": \"" + (folder / "apart/points.ply").string() + "\", ");
  EXPECT_EQ(read_dataset(folder / "").points.size(), 2u);
}

TEST(Dataset, DoesWithoutFilesThatAreNoPoints) {
  const TemporaryFolder folder;
  write_transforms(folder, 2, "\"ply_file_path\": \"points.ply\", ");
  const auto with = [&](std::string text, const std::string& from, const std::string& to) {
    if (const std::size_t at = text.find(from); at != std::string::npos)
      text.replace(at, from.size(), to);
    write_text(folder / "points.ply", text);
    const Dataset dataset = read_dataset(folder / "");
    std::string sentences = std::to_string(dataset.points.size()) + " points. ";
    for (const Remark& remark : dataset.remarks) sentences += describe(remark) + " ";
    return sentences;
  };
  using ::testing::HasSubstr;
  using ::testing::StartsWith;
  EXPECT_THAT(with(cloud, "", ""), StartsWith("2 points."));
  EXPECT_THAT(with(cloud, "0.5 -1", "nan -1"),
              AllOf(StartsWith("1 points."), HasSubstr("1 point is damaged or not finite")));
  EXPECT_THAT(with(cloud, "property float y", "property float w"),
              AllOf(StartsWith("0 points."), HasSubstr("points.ply"), HasSubstr("'y'")));
  EXPECT_THAT(with(cloud, "uint8 red", "float red"), StartsWith("2 points."));
  EXPECT_THAT(with(cloud, "vertex 2", "vertex 2000000000"),
              AllOf(StartsWith("0 points."), HasSubstr("points.ply")));
  EXPECT_THAT(with(cloud, "element vertex", "element corner"), HasSubstr("'vertex'"));
  const std::vector<std::byte> whole = [&] {
    const auto bytes = std::as_bytes(std::span(std::string_view(cloud)));
    return std::vector<std::byte>(bytes.begin(), bytes.end());
  }();
  for (std::size_t size = 0; size < whole.size(); ++size) {
    write_bytes(folder / "points.ply", std::span(whole).first(size));
    EXPECT_LE(read_dataset(folder / "").points.size(), 2u);
  }
}

TEST(Dataset, MasksExcludePixels) {
  const TemporaryFolder folder;
  write_transforms(folder, 2);
  Image8 mask(8, 6, glm::u8vec4(255));
  for (int y = 0; y < 6; ++y) mask.at(3, y) = glm::u8vec4(0, 0, 0, 255);
  // Any other value is valid, and alpha does not matter.
  mask.at(7, 5) = glm::u8vec4(1, 1, 1, 0);
  mask.at(6, 5) = glm::u8vec4(0, 0, 1, 255);
  write_image(folder / "masks/1.png", mask);
  const auto write = [&](const std::string& head) {
    write_text(folder / "transforms.json",
               transforms(intrinsics + std::string("\"w\": 8, \"h\": 6, ") + head,
                          {frame("images/0.png"),
                           frame("images/1.png", 1, "\"mask_path\": \"masks/1.png\", ")}));
  };
  write("");
  Dataset dataset = read_dataset(folder / "");
  EXPECT_TRUE(dataset.test[0].ignored.empty());
  ASSERT_EQ(dataset.train[0].ignored.size(), 48u);
  for (std::size_t i = 0; i < 48; ++i) EXPECT_EQ(dataset.train[0].ignored()[i], i % 8 == 3) << i;
  EXPECT_FALSE(dataset.has_alpha);
  EXPECT_EQ(dataset.train[0].image().pixels, an_image(8, 6, 1).pixels);
  EXPECT_THAT(dataset.remarks,
              ::testing::Contains(Remark{&remarks::pixels_masked, {{"masked", 1}, {"all", 2}}}));
  // Half the size: the second column of four has an excluded pixel.
  dataset = read_dataset(folder / "", {.scale = 0.5});
  ASSERT_EQ(dataset.train[0].ignored.size(), 12u);
  for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(dataset.train[0].ignored()[i], i % 4 == 1) << i;
  write("");
  write_image(folder / "images_2/0.png", an_image(4, 3));
  write_image(folder / "images_2/1.png", an_image(4, 3));
  EXPECT_THAT(refusal(folder / "", {.images_folder = 2}), ErrorIn("masks_2/1.png"));
  write_image(folder / "masks_2/1.png", Image8(4, 3, glm::u8vec4(255)));
  EXPECT_TRUE(read_dataset(folder / "", {.images_folder = 2}).train[0].ignored.empty());
  write_image(folder / "masks/1.png", Image8(8, 6, glm::u8vec4(0, 0, 0, 255)));
  EXPECT_THAT(refusal(folder / ""), ErrorIn("masks/1.png"));
  write_image(folder / "masks/1.png", Image8(7, 6, glm::u8vec4(255)));
  EXPECT_THAT(refusal(folder / ""), ErrorIn("masks/1.png", 7, 6, 8));
  std::filesystem::remove(folder / "masks/1.png");
  EXPECT_THAT(refusal(folder / ""), ErrorIn("masks/1.png", "images/1.png"));
}

/// Reads two photographs of 64 x 48 pixels with a lens and scale. The second one has the mask,
/// which excludes the pixel `at`, and is grey, except for this pixel with the red `value`.
Photograph masked_pixel(const std::string& lens, double scale, glm::ivec2 at, std::uint8_t value) {
  const TemporaryFolder folder;
  Image8 image(64, 48, glm::u8vec4(128, 128, 128, 255)), mask(64, 48, glm::u8vec4(255));
  write_image(folder / "a.png", image);
  image.at(at.x, at.y).r = value;
  write_image(folder / "b.png", image);
  mask.at(at.x, at.y) = glm::u8vec4(0, 0, 0, 255);
  write_image(folder / "mask.png", mask);
  write_text(folder / "transforms.json",
             transforms("\"fl_x\": 60, \"w\": 64, \"h\": 48, " + lens,
                        {frame("a.png"), frame("b.png", 1, "\"mask_path\": \"mask.png\", ")}));
  return read_dataset(folder / "", {.scale = scale}).train[0];
}

TEST(Dataset, NoPixelThatIsUsedDependsOnAnExcludedOne) {
  for (const char* lens : {"", "\"k1\": 0.1, ", "\"k1\": -0.1, ", "\"is_fisheye\": true, "})
    for (const double scale : {1.0, 0.7, 1.0 / 32})
      for (const glm::ivec2 at : {glm::ivec2(20, 30), glm::ivec2(37, 11)}) {
        if (scale < 0.1 && lens != std::string()) continue;  // no row is left beside the border
        SCOPED_TRACE(lens + std::to_string(scale));
        const Photograph black = masked_pixel(lens, scale, at, 0);
        const Photograph white = masked_pixel(lens, scale, at, 255);
        const Image8 black_image = black.image(), white_image = white.image();
        const std::vector<std::uint8_t> mask = black.ignored();
        ASSERT_EQ(mask.size(), black_image.pixels.size());
        std::size_t differ = 0;
        for (std::size_t i = 0; i < mask.size(); ++i) {
          const bool differs = black_image.pixels[i] != white_image.pixels[i];
          EXPECT_TRUE(mask[i] == 1 || !differs) << i;
          differ += differs;
        }
        // The others that are ignored have small weights.
        const auto ignored = std::count(mask.begin(), mask.end(), 1);
        EXPECT_GE(ignored, 1);
        EXPECT_LE(ignored, 36);
        EXPECT_TRUE(differ >= 1 || scale < 0.1);
      }
}

// ---- Errors ---------------------------------------------------------------------------------

TEST(Dataset, NamesTheImagesThatAreMissing) {
  const TemporaryFolder folder;
  write_transforms(folder, 26);
  for (const int i : {3, 8})
    std::filesystem::remove(folder / ("images/" + std::to_string(i) + ".png"));
  EXPECT_THAT(refusal(folder / ""),
              ErrorAt("transforms.json", 2, 26, "images/3.png", "images/8.png"));
  EXPECT_THAT(refusal(folder / "", {.part = DatasetPart::test}), Names(1, 4));
  std::filesystem::remove_all(folder / "images");
  // The error lists twelve images by name, and the number of the others.
  EXPECT_THAT(refusal(folder / ""), AllOf(ErrorAt("transforms.json", 26, "images/20.png", 14),
                                          Not(Names("images/21.png"))));

  const TemporaryFolder colmap;
  write_colmap(colmap, 3);
  EXPECT_THAT(refusal(colmap / "", {.images_folder = 8}),
              Names(3, "images_8", "b.png", "c.png", "a.png"));
}

TEST(Dataset, RefusesImagesOfAnotherSize) {
  const TemporaryFolder folder;
  write_colmap(folder, 2);
  write_image(folder / "images/b.png", an_image(6, 8));
  EXPECT_THAT(refusal(folder / ""), ErrorIn("images/b.png", 6, 8));
  write_text(folder / "images/b.png", "no image");
  EXPECT_THAT(refusal(folder / ""), ErrorIn("images/b.png"));
}

TEST(Dataset, RefusesLensesThatItCannotUndo) {
  const TemporaryFolder folder;
  const auto with = [&](const char* head) {
    write_transforms(folder, 2, head);
    return refusal(folder / "");
  };
  EXPECT_THAT(with("\"ftheta_p0\": 0.5, "), Names("ftheta_p0"));
  EXPECT_THAT(with("\"k4\": 0.5, "), Names("k4"));
  EXPECT_THAT(with("\"k1\": \"much\", "), Names(0, "k1"));
  EXPECT_NE(with("\"k1\": 90, "), std::nullopt);
  EXPECT_EQ(with("\"is_fisheye\": false, \"k4\": 0, \"camera_model\": \"OPENCV\", "), std::nullopt);

  ColmapFixture model = upright_colmap(2);
  model.cameras[0] = {1, 99, "MYSTERY", 8, 6, {10, 9, 4, 3, 0.1}};
  std::filesystem::remove(folder / "transforms.json");
  write_text(folder / "sparse/0", model);
  EXPECT_THAT(refusal(folder / ""), Names("MYSTERY"));
}

TEST(Dataset, APanoramaInJsonBecomesSixViews) {
  const TemporaryFolder folder;
  write_transforms(folder, 3, "\"camera_model\": \"EQUIRECTANGULAR\", ");
  const Dataset dataset = read_dataset(folder / "");
  EXPECT_EQ(dataset.train.size() + dataset.test.size(), 18u);
}

TEST(Dataset, RefusesPosesThatAreNoRotations) {
  const TemporaryFolder folder;
  write_image(folder / "a.png", an_image(8, 6));
  const auto with = [&](const std::string& matrix) {
    write_text(folder / "transforms.json",
               transforms(intrinsics,
                          {"{\"file_path\": \"a.png\", \"transform_matrix\": " + matrix + "}"}));
    return refusal(folder / "");
  };
  EXPECT_THAT(with("[[2,0,0,0],[0,2,0,0],[0,0,2,0]]"),
              ErrorIn("transforms.json", "a.png", "transform_matrix"));
  EXPECT_THAT(with("[[-1,0,0,0],[0,1,0,0],[0,0,1,0]]"), Names("transform_matrix"));
}

TEST(Dataset, RefusesAnEmptySplit) {
  const TemporaryFolder folder;
  write_transforms(folder, 3);
  EXPECT_NE(refusal(folder / "", {.test_every = 1}), std::nullopt);
  write_text(folder / "transforms.json", transforms(intrinsics, {}));
  EXPECT_THAT(refusal(folder / "", {.part = DatasetPart::test}), ErrorIn("transforms.json"));

  write_text(folder / "transforms_test.json", transforms(intrinsics, {frame("images/0.png")}));
  EXPECT_THAT(refusal(folder / ""), ErrorIn("transforms_train.json"));
  write_text(folder / "transforms_train.json", transforms(intrinsics, {frame("images/0.png")}));
  EXPECT_EQ(refusal(folder / "", {.part = DatasetPart::train}), std::nullopt);
  write_text(folder / "transforms_test.json", transforms(intrinsics, {}));
  EXPECT_THAT(refusal(folder / "", {.part = DatasetPart::test}), ErrorIn("transforms_test.json"));
  write_text(folder / "transforms_test.json", transforms(intrinsics, {frame("images/0.png")}));
  write_text(folder / "transforms_train.json", transforms(intrinsics, {}));
  EXPECT_THAT(refusal(folder / ""), Names(0, 1));
}

TEST(Dataset, NeedsNoTestViews) {
  const TemporaryFolder folder;
  write_transforms(folder, 1);
  // The only photograph is for the training; an evaluation of the test views has it, too.
  const Dataset one = read_dataset(folder / "");
  EXPECT_EQ(one.train.size(), 1u);
  EXPECT_TRUE(one.test.empty());
  EXPECT_EQ(read_dataset(folder / "", {.part = DatasetPart::test}).test.size(), 1u);
  write_text(folder / "transforms_train.json", transforms(intrinsics, {frame("images/0.png")}));
  write_text(folder / "transforms_test.json", transforms(intrinsics, {}));
  const Dataset split = read_dataset(folder / "");
  EXPECT_EQ(split.train.size(), 1u);
  EXPECT_TRUE(split.test.empty());
}

TEST(Dataset, RefusesWhatIsNoDataset) {
  const TemporaryFolder folder;
  EXPECT_NE(refusal(folder / "nowhere"), std::nullopt);
  EXPECT_NE(refusal(folder / ""), std::nullopt);
  write_text(folder / "transforms.json", "{\"cameras\": []}");
  EXPECT_THAT(refusal(folder / ""), Names("frames"));
  write_text(folder / "transforms.json", "{\"frames\": [");
  EXPECT_NE(refusal(folder / ""), std::nullopt);
  // This holds for any content.
  write_text(folder / "transforms.json", "glTF" + std::string(100, '['));
  EXPECT_NE(refusal(folder / ""), std::nullopt);
  for (const std::string word : {"NaN", "Infinity", "-Infinity"}) {
    write_text(folder / "transforms.json", "{\"fl_x\": " + word + ", \"frames\": []}");
    EXPECT_THAT(refusal(folder / ""), Names("no photographs"));
  }
  write_text(folder / "transforms.json",
             transforms(intrinsics, {"{\"transform_matrix\": [[1,0,0,0],[0,1,0,0],[0,0,1,0]]}"}));
  EXPECT_THAT(refusal(folder / ""), Names(0, "file_path"));
  write_text(folder / "transforms.json", transforms(intrinsics, {frame("train/0.png")}));
  EXPECT_THAT(refusal(folder / "", {.images_folder = 2}),
              Names(0, "train/0.png", "images/", "images_2/"));
}

TEST(Dataset, FollowsParentsAndLinksToPhotographs) {
  const TemporaryFolder folder;
  write_image(folder / "apart/b.png", an_image(8, 6, 2));
  write_image(folder / "set/images/a.png", an_image(8, 6));
  std::filesystem::create_symlink(folder / "apart/b.png", folder / "set/images/link.png");
  std::filesystem::create_directory_symlink(folder / "apart", folder / "set/all");
  std::filesystem::create_symlink(folder / "nowhere.png", folder / "set/images/broken.png");
  const auto with = [&](const std::string& name) {
    write_text(folder / "set/transforms.json",
               transforms(intrinsics, {frame(name), frame("images/a.png")}));
    return refusal(folder / "set");
  };
  EXPECT_EQ(with("./images/a.png"), std::nullopt);
  for (const char* name : {"images/link.png", "all/b.png", "../apart/b.png", "../apart/b",
                           "images/../../apart/b.png"}) {
    SCOPED_TRACE(name);
    EXPECT_EQ(with(name), std::nullopt);
    const Dataset dataset = read_dataset(folder / "set");
    EXPECT_THAT(names({dataset.test[0], dataset.train[0]}), ::testing::Contains(name));
    EXPECT_THAT((std::array{dataset.test[0].image().pixels, dataset.train[0].image().pixels}),
                ::testing::Contains(an_image(8, 6, 2).pixels));
  }
  EXPECT_THAT(with("images/broken.png"), Names("images/broken.png"));
  EXPECT_THAT(with("images"), Names("images"));
  EXPECT_EQ(with((folder / "apart/b.png").string()), std::nullopt);
  EXPECT_THAT(with((folder / "apart/c.png").string()), Names("apart/c.png"));
  EXPECT_THAT(with("file:b.png"), Names("file:b.png"));
  // A name is not a URI: escapes in it are plain text.
  write_image(folder / "set/images/a%20b.png", an_image(8, 6));
  EXPECT_EQ(with("images/a%20b.png"), std::nullopt);
}

TEST(Dataset, ReadsColmapWithLinksAsNerfstudioMakesIt) {
  const TemporaryFolder folder;
  const ColmapFixture model = upright_colmap(2);
  write_binary(folder / "set/colmap/sparse/0", model);
  write_image(folder / "apart/a.png", an_image(8, 6));
  write_image(folder / "apart/b.png", an_image(8, 6, 1));
  std::filesystem::create_directory_symlink(folder / "apart", folder / "set/images");
  const Dataset dataset = read_dataset(folder / "set");
  EXPECT_EQ(dataset.train[0].image().pixels, an_image(8, 6, 1).pixels);
  EXPECT_EQ(dataset.points.size(), 1u);
}

TEST(Dataset, RefusesMorePhotographsThanMemoryBeforeItDecodesThem) {
  const TemporaryFolder folder;
  ColmapFixture model = upright_colmap(3);
  model.cameras[0].width = model.cameras[0].height = 60000;
  write_binary(folder / "sparse/0", model);
  for (const char* name : {"images/a.png", "images/b.png", "images/c.png"})
    write_text(folder / name, "never looked at");
  EXPECT_THAT(refusal(folder / ""), Names(4, "--max-memory", "--scale"));
  EXPECT_NE(refusal(folder / "", {.scale = 0.1}), std::nullopt);
}

TEST(Dataset, TruncatedTransformsEndInAnErrorWithItsPlace) {
  const TemporaryFolder folder;
  write_transforms(folder, 2);
  Input input = Input::open(folder / "transforms.json");
  const std::vector<std::byte> whole = input.read_rest();
  const auto read = [&](std::span<const std::byte> bytes) {
    write_bytes(folder / "transforms.json", bytes);
    read_dataset(folder / "", {.part = DatasetPart::test});
  };
  EXPECT_NO_THROW(read(whole));
  EXPECT_EQ(survive_truncation(whole, read).read, 0u);
}

// ---- Real photographs -----------------------------------------------------------------------

std::filesystem::path data(const char* name) {
  return std::filesystem::path(TUREEN_SOURCE_DIR) / "../shared/data" / name;
}

TEST(DatasetData, FoxIsUndistorted) {
  if (!std::filesystem::exists(data("photos/fox"))) GTEST_SKIP() << "no ../shared/data";
  // Only the test views, because reading takes long.
  const Dataset dataset =
      read_dataset(data("photos/fox"), {.scale = 0.25, .part = DatasetPart::test});
  ASSERT_EQ(dataset.test.size(), 9u);
  EXPECT_EQ(dataset.test[0].camera.name, "images/0001.jpg");
  EXPECT_FALSE(dataset.has_alpha);
  const Camera& camera = dataset.test[0].camera;
  EXPECT_NEAR(camera.fx, 1375.52 / 4, 1e-9);
  EXPECT_NEAR(camera.fy, 1374.49 / 4, 1e-9);
  // 270 x 480, minus a few whole pixels that the photographs do not cover. The principal point
  // keeps its fraction.
  EXPECT_GE(camera.width, 264);
  EXPECT_LT(camera.width, 270);
  EXPECT_GE(camera.height, 472);
  EXPECT_LT(camera.height, 480);
  const double left = 554.558 / 4 - camera.cx;
  EXPECT_NEAR(left, std::round(left), 1e-9);
}

TEST(DatasetData, BottleHasPointsInFrontOfItsCameras) {
  if (!std::filesystem::exists(data("photos/bottle"))) GTEST_SKIP() << "no ../shared/data";
  const Dataset dataset = read_dataset(data("photos/bottle"), {.scale = 0.25});
  EXPECT_EQ(dataset.train.size(), 88u);
  EXPECT_EQ(dataset.test.size(), 13u);
  ASSERT_EQ(dataset.points.size(), 6885u);
  EXPECT_THAT(described(dataset.remarks),
              Not(::testing::Contains(::testing::StartsWith("Lens distortion was removed"))));
  // Structure from motion took the colours of the points from these images. Some points are hidden
  // in some views. So the pixel at a point is only closer to its colour than to the colours of
  // other points.
  double own = 0, others = 0;
  std::size_t inside = 0;
  for (const Photograph& photograph : dataset.test) {
    const Image8 image = photograph.image();
    for (std::size_t i = 0; i < dataset.points.size(); ++i) {
      const Camera& camera = photograph.camera;
      const glm::dvec4 p = camera.view_from_world * glm::dvec4(dataset.points[i].position, 1);
      const double x = camera.cx + camera.fx * p.x / -p.z, y = camera.cy - camera.fy * p.y / -p.z;
      if (!(p.z < 0 && x >= 0 && y >= 0 && x < camera.width && y < camera.height)) continue;
      const glm::dvec3 color(image.at(int(x), int(y)));
      const DatasetPoint& other = dataset.points[(i + 3000) % dataset.points.size()];
      own += glm::length(color - glm::dvec3(dataset.points[i].color));
      others += glm::length(color - glm::dvec3(other.color));
      ++inside;
    }
  }
  EXPECT_GT(double(inside), 0.5 * 13 * 6885);
  // 0.55 here; 0.97 if x or y has the wrong sign.
  EXPECT_LT(own, 0.7 * others);
}

TEST(DatasetData, LegoHasItsOwnSplitAndAlpha) {
  if (!std::filesystem::exists(data("rendered/lego"))) GTEST_SKIP() << "no ../shared/data";
  const Dataset dataset = read_dataset(data("rendered/lego"), {.scale = 0.25});
  EXPECT_EQ(dataset.train.size(), 100u);
  EXPECT_EQ(dataset.test.size(), 25u);
  EXPECT_TRUE(dataset.has_alpha);
  const Camera& camera = dataset.test[3].camera;
  EXPECT_EQ(camera.width, 200);
  EXPECT_NEAR(camera.fx, 1111.111 / 4, 1e-3);
  EXPECT_EQ(camera.cx, 100);
  // The cameras are on a sphere around the origin, and look at it.
  for (const Photograph& photograph : dataset.train) {
    EXPECT_NEAR(glm::length(photograph.camera.eye()), 4.0311, 1e-3);
    const glm::dvec3 backward = photograph.camera.world_from_view_rotation()[2];
    EXPECT_NEAR(glm::dot(backward, glm::normalize(photograph.camera.eye())), 1.0, 1e-5);
  }
}

}  // namespace dataset_test
}  // namespace tureen
