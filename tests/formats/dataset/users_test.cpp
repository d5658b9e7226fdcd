// Datasets as people have them: what is near, partly missing or in another place is found, and what
// cannot be used costs only itself.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "base/platform/scratch_file.hpp"
#include "formats/dataset/alpha.hpp"
#include "formats/dataset/dataset.hpp"
#include "formats/dataset/near_files.hpp"
#include "tests/formats/dataset/dataset_fixture.hpp"
#include "tests/formats/format_testing.hpp"

namespace tureen {
namespace users_test {

using namespace tureen::test;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// images/a.png .. and a model of `count` photographs in text.
ColmapFixture write_dataset(const TemporaryFolder& folder, int count) {
  ColmapFixture model = upright_colmap(count);
  write_text(folder / "sparse/0", model);
  for (int i = 0; i < count; ++i)
    write_image(folder / ("images/" + model.images[std::size_t(i)].name), an_image(8, 6, i));
  return model;
}

std::vector<std::string> names(const std::vector<Photograph>& photographs) {
  std::vector<std::string> result;
  for (const Photograph& photograph : photographs) result.push_back(photograph.camera.name);
  return result;
}

std::string sentences(const Dataset& dataset) {
  std::string text;
  for (const Remark& remark : dataset.remarks) text += describe(remark) + "\n";
  return text;
}

std::optional<Refusal> refusal(const std::filesystem::path& path,
                               const DatasetOptions& options = {}) {
  return error_of([&] { read_dataset(path, options); });
}

// ---- Names ----------------------------------------------------------------------------------

TEST(NearFiles, FindOneFileWhoseNameIsNear) {
  const TemporaryFolder folder;
  for (const char* name : {"cam0/V_1.JPG", "cam1/v_2.png", "Gr\u00f6\u00dfe 1.png", "v.3.png",
                           "masks/v_4.png", "a/x.png", "b/x.png", "y.png", "y.jpg"})
    write_image(folder / name, an_image(1, 1));
  NearFiles files;
  const auto find = [&](const std::string& name) {
    const auto found = files.find(folder / "", name);
    return found
               ? found->path.lexically_relative(folder / "").string() + (found->is_exact ? "" : "~")
               : "";
  };
  EXPECT_EQ(find("cam1/v_2.png"), "cam1/v_2.png");
  EXPECT_EQ(find("cam1/v_2"), "cam1/v_2.png");
  EXPECT_EQ(find("cam0/v_1.jpg"), "cam0/V_1.JPG~");
  EXPECT_EQ(find("cam0\\v_1.jpg"), "cam0/V_1.JPG~");
  EXPECT_EQ(find("v_2.png"), "cam1/v_2.png~");
  EXPECT_EQ(find("D:/scan/cam1/v_2.png"), "cam1/v_2.png~");
  EXPECT_EQ(find("cam1/v_2.jpeg"), "cam1/v_2.png~");
  // "o" and a combining diaeresis, as macOS stores names.
  EXPECT_EQ(find("Gro\u0308\u00dfe 1.png"), "Gr\u00f6\u00dfe 1.png~");
  EXPECT_EQ(find("v.3"), "v.3.png");
  EXPECT_EQ(find("x.png"), "");  // two fit
  EXPECT_EQ(find("a/x.png"), "a/x.png");
  EXPECT_EQ(find("c/x.png"), "");  // in another folder
  EXPECT_EQ(find("v_4.png"), "");  // a mask
  EXPECT_EQ(find("masks/V_4.png"), "masks/v_4.png~");
  EXPECT_EQ(find("Y.png"), "y.png~");  // the one with the suffix
  EXPECT_EQ(find("Y.webp"), "");
  EXPECT_EQ(find("z.png"), "");
  EXPECT_EQ(find(std::string("a\0b", 3)), "");
  EXPECT_EQ(files.nearest(folder / "", "v_22.png"), "v_2.png");
}

TEST(UsersDataset, FindsPhotographsUnderNearNamesAndSaysSo) {
  const TemporaryFolder folder;
  ColmapFixture model = write_dataset(folder, 4);
  for (auto& image : model.images) image.name = "C:\\scan\\images\\" + image.name;
  write_text(folder / "sparse/0", model);
  const Dataset dataset = read_dataset(folder / "");
  EXPECT_EQ(dataset.train.size() + dataset.test.size(), 4u);
  EXPECT_THAT(sentences(dataset), AllOf(HasSubstr("4 photographs were found by a similar name"),
                                        HasSubstr("C:\\scan\\images\\")));
}

TEST(UsersDataset, TakesNoFileForTwoPhotographs) {
  const TemporaryFolder folder;
  ColmapFixture model = write_dataset(folder, 4);
  model.images[0].name = "cam0/d.png";
  model.images[1].name = "cam1/d.png";
  model.images[3].name = "cam2/d.png";
  write_text(folder / "sparse/0", model);
  EXPECT_THAT(refusal(folder / ""), Names(3, 4, "cam0/d.png", "cam2/d.png"));
}

TEST(UsersDataset, NamesWhatStandsInsteadOfAPhotograph) {
  const TemporaryFolder folder;
  write_dataset(folder, 8);
  write_text(folder / "images/a.png", "");
  write_text(folder / "images/b.png", "version https://git-lfs.github.com/spec/v1\noid sha256:0\n");
  write_text(folder / "images/c.png", "<!DOCTYPE html><html>404</html>");
  std::filesystem::remove(folder / "images/d.png");
  write_text(folder / "images/d.heic", std::string("\0\0\0\x18"
                                                   "ftypheic\0\0\0\0",
                                                   16));
  const Dataset dataset = read_dataset(folder / "");
  EXPECT_EQ(dataset.train.size() + dataset.test.size(), 4u);
  EXPECT_THAT(sentences(dataset),
              AllOf(HasSubstr("the file is empty"), HasSubstr("Git LFS pointer"),
                    HasSubstr("a web page"), HasSubstr("a HEIC image")));
}

TEST(UsersDataset, TakesThePhotographsBesideTheModel) {
  const TemporaryFolder folder;
  write_dataset(folder, 4);
  std::filesystem::create_directory(folder / "dense");
  std::filesystem::rename(folder / "sparse", folder / "dense/sparse");
  EXPECT_EQ(read_dataset(folder / "").train.size(), 3u);
  // The originals stay in images; the undistorted ones are beside the model.
  std::filesystem::rename(folder / "images", folder / "dense/images");
  for (const char* name : {"a.png", "b.png", "c.png", "d.png"})
    write_text(folder / ("images/" + std::string(name)), "the originals");
  EXPECT_EQ(read_dataset(folder / "").train.size(), 3u);
}

TEST(UsersDataset, ReadsTextThatItKnowsAndNamesUtf16) {
  const TemporaryFolder folder;
  write_dataset(folder, 4);
  write_text(folder / "sparse/0/images.txt", std::string("\xff\xfe#\0 \0", 6));
  EXPECT_THAT(refusal(folder / ""), ErrorIn("images.txt", "UTF-16"));
  write_text(folder / "transforms.json", std::string("\xff\xfe{\0}\0", 6));
  EXPECT_THAT(refusal(folder / ""), ErrorIn("transforms.json", "UTF-16"));
}

TEST(UsersDataset, DoesWithoutPointsThatCannotBeRead) {
  const TemporaryFolder folder;
  write_dataset(folder, 4);
  std::filesystem::remove(folder / "sparse/0/points3D.txt");
  write_text(folder / "sparse/0/points3D.bin", "short");
  const Dataset dataset = read_dataset(folder / "");
  EXPECT_THAT(dataset.points, IsEmpty());
  EXPECT_THAT(sentences(dataset), HasSubstr("points cannot be read: 0/points3D"));
}

TEST(UsersDataset, ReportsNamesOfTestViewsThatDoNotExist) {
  const TemporaryFolder folder;
  write_dataset(folder, 4);
  write_text(folder / "test.txt", "a.png\nsub/zz.png\n");
  const Dataset dataset = read_dataset(folder / "");
  EXPECT_THAT(names(dataset.test), ElementsAre("a.png"));
  EXPECT_THAT(sentences(dataset), HasSubstr("that the dataset does not have: sub/zz.png"));
}

// ---- One bad item costs that item -----------------------------------------------------------

TEST(UsersDataset, SkipsPhotographsThatCannotBeUsed) {
  const TemporaryFolder folder;
  ColmapFixture model = write_dataset(folder, 12);
  std::filesystem::remove(folder / "images/b.png");
  write_text(folder / "images/c.png", "no image");
  write_image(folder / "images/d.png", an_image(5, 5));
  model.images[4].rotation[0] = NAN;
  model.cameras.push_back({2, 99, "MYSTERY", 8, 6, {1}});
  model.cameras.push_back({3, 98, "UNUSED", 8, 6, {1}});
  model.images[5].camera = 2;
  model.points.push_back({8, {NAN, 0, 0}, {0, 0, 0}, 0});
  write_text(folder / "sparse/0", model);
  const Dataset dataset = read_dataset(folder / "");
  EXPECT_EQ(dataset.train.size() + dataset.test.size(), 7u);
  EXPECT_EQ(dataset.points.size(), 1u);
  EXPECT_THAT(
      sentences(dataset),
      AllOf(HasSubstr("(b.png): the file is missing in"), HasSubstr("c.png"), HasSubstr("5 x 5"),
            HasSubstr("(e.png): its pose is not finite"), HasSubstr("MYSTERY"),
            Not(HasSubstr("UNUSED")), HasSubstr("1 point is damaged or not finite")));
  EXPECT_THAT(refusal(folder / "", {.is_strict = true}), Names("b.png", "--strict"));
  // Too few are left.
  for (const char* name : {"g", "h"})
    std::filesystem::remove(folder / ("images/" + std::string(name) + ".png"));
  EXPECT_THAT(refusal(folder / ""), Names(7, 12, "g.png", "h.png", "MYSTERY"));
}

TEST(UsersDataset, SkipsFramesThatJsonCannotHold) {
  const TemporaryFolder folder;
  std::string frames;
  for (int i = 0; i < 5; ++i) {
    const std::string name = "images/" + std::to_string(i) + ".png";
    write_image(folder / name, an_image(8, 6, i));
    const char* x = i == 1 ? "NaN" : i == 3 ? "-1e999" : "1";
    frames += std::string(i > 0 ? "," : "") + R"({"file_path": ")" + name +
              R"(", "transform_matrix": [[1,0,0,)" + x + "],[0,1,0,0],[0,0,1,0]]}";
  }
  write_text(folder / "transforms.json",
             R"({"fl_x": 10, "comment": "NaN stays \" NaN", "frames": [)" + frames + "]}");
  const Dataset dataset = read_dataset(folder / "");
  EXPECT_EQ(dataset.train.size() + dataset.test.size(), 3u);
  EXPECT_THAT(sentences(dataset), HasSubstr("2 of 5 photographs were skipped (images/1.png, "
                                            "images/3.png): transform_matrix"));
}

// ---- What a dataset says --------------------------------------------------------------------

TEST(UsersDataset, HasTheSplitThatItNames) {
  const TemporaryFolder folder;
  std::string frames;
  for (int i = 0; i < 6; ++i) {
    const std::string name = "images/" + std::to_string(i) + ".png";
    write_image(folder / name, an_image(8, 6, i));
    frames += std::string(i > 0 ? "," : "") + R"({"file_path": ")" + name +
              R"(", "transform_matrix": [[1,0,0,0],[0,1,0,0],[0,0,1,0]]})";
  }
  const auto with = [&](const std::string& lists) {
    write_text(folder / "transforms.json",
               R"({"fl_x": 10, )" + lists + R"("frames": [)" + frames + "]}");
    return read_dataset(folder / "");
  };
  Dataset dataset = with(R"("train_filenames": ["images/0.png", "./images/1.png"],
                            "val_filenames": ["images/2.png"], "test_filenames": ["images/4.png"], )");
  EXPECT_THAT(names(dataset.train), ElementsAre("images/0.png", "images/1.png"));
  EXPECT_THAT(names(dataset.test), ElementsAre("images/4.png"));
  EXPECT_THAT(sentences(dataset), HasSubstr("3 photographs are in no list"));
  dataset = with(R"("val_filenames": ["images/2.png"], )");
  EXPECT_THAT(names(dataset.test), ElementsAre("images/2.png"));
  EXPECT_EQ(dataset.train.size(), 5u);
  dataset = with(R"("train_filenames": ["images/0.png", "images/1.png"], )");
  EXPECT_EQ(dataset.test.size(), 4u);
  dataset = with(R"("test_filenames": ["nowhere.png"], )");
  EXPECT_EQ(dataset.test.size(), 1u);
  EXPECT_THAT(sentences(dataset), HasSubstr("every n-th photograph is a test view"));
  dataset = with(R"("test_frames": [{"file_path": "images/7.png",
                      "transform_matrix": [[1,0,0,0],[0,1,0,0],[0,0,1,0]]}], )");
  EXPECT_THAT(sentences(dataset), HasSubstr("images/7.png"));
}

TEST(UsersDataset, ReadsTheTestListOfGaussianSplatting) {
  const TemporaryFolder folder;
  write_dataset(folder, 6);
  write_text(folder / "sparse/0/test.txt",
             "\xef\xbb\xbf"
             "b.png\r\nd.png\r\n\r\n");
  const Dataset dataset = read_dataset(folder / "");
  EXPECT_THAT(names(dataset.test), ElementsAre("b.png", "d.png"));
}

TEST(UsersDataset, TrainsWithoutTestViewsThatWereNeverRendered) {
  const TemporaryFolder folder;
  const auto write = [&](const char* file, const std::string& part) {
    std::string frames;
    for (int i = 0; i < 3; ++i)
      frames += std::string(i > 0 ? "," : "") + R"({"file_path": ")" + part + std::to_string(i) +
                R"(", "transform_matrix": [[1,0,0,0],[0,1,0,0],[0,0,1,0]]})";
    write_text(folder / file, R"({"fl_x": 10, "frames": [)" + frames + "]}");
  };
  write("transforms_train.json", "train/");
  write("transforms_test.json", "test/");
  for (int i = 0; i < 3; ++i)
    write_image(folder / ("train/" + std::to_string(i) + ".png"), an_image(8, 6, i));
  const Dataset dataset = read_dataset(folder / "");
  EXPECT_EQ(dataset.train.size(), 3u);
  EXPECT_THAT(dataset.test, IsEmpty());
  EXPECT_THAT(sentences(dataset), HasSubstr("3 test views are missing"));
  EXPECT_NE(refusal(folder / "", {.is_strict = true}), std::nullopt);
  EXPECT_NE(refusal(folder / "", {.part = DatasetPart::test}), std::nullopt);
}

TEST(UsersDataset, TakesTheLargestModelAndPointsBesideIt) {
  const TemporaryFolder folder;
  ColmapFixture model = write_dataset(folder, 6);
  std::filesystem::rename(folder / "sparse/0", folder / "sparse/1");
  ColmapFixture small = upright_colmap(2);
  write_text(folder / "sparse/0", small);
  std::filesystem::remove(folder / "sparse/1/points3D.txt");
  write_text(folder / "sparse/1/points3D.ply",
             "ply\nformat ascii 1.0\nelement vertex 1\nproperty double x\nproperty double y\n"
             "property double z\nproperty float red\nproperty float green\nproperty float blue\n"
             "end_header\n1 2 3 0 0.5 1\n");
  const Dataset dataset = read_dataset(folder / "");
  EXPECT_EQ(dataset.train.size() + dataset.test.size(), 6u);
  ASSERT_EQ(dataset.points.size(), 1u);
  EXPECT_EQ(dataset.points[0].color, glm::u8vec3(0, 128, 255));
  EXPECT_THAT(sentences(dataset), HasSubstr("1 with 6 photographs is used, not 0"));
}

TEST(UsersDataset, ReadsAModelBesideItsPhotographs) {
  const TemporaryFolder folder;
  const ColmapFixture model = upright_colmap(4);
  write_text(folder / "", model);
  for (const auto& image : model.images) write_image(folder / image.name, an_image(8, 6));
  EXPECT_TRUE(is_dataset(folder / ""));
  EXPECT_EQ(read_dataset(folder / "").train.size(), 3u);
}

TEST(UsersDataset, TakesSmallerPhotographsWithTheirCameras) {
  const TemporaryFolder folder;
  ColmapFixture model = upright_colmap(4);
  model.cameras[0] = {1, 1, "PINHOLE", 33, 18, {40, 36, 16.5, 9}};
  write_text(folder / "sparse/0", model);
  for (const auto& image : model.images)
    write_image(folder / ("images/" + image.name), an_image(8, 5));
  Dataset dataset = read_dataset(folder / "");
  EXPECT_THAT(sentences(dataset), HasSubstr("1/4 of their cameras' size"));
  EXPECT_NEAR(dataset.train[0].camera.fx, 40 * 8.0 / 33, 1e-12);
  std::filesystem::rename(folder / "images", folder / "images_4");
  dataset = read_dataset(folder / "");
  EXPECT_THAT(sentences(dataset), HasSubstr("the photographs are those of images_4"));
  for (const auto& image : model.images)
    write_image(folder / ("images_4/" + image.name), an_image(8, 3));
  EXPECT_THAT(refusal(folder / ""), Names(33, 18, 8, 3));
}

TEST(UsersDataset, FindsMasksBesideThePhotographs) {
  const TemporaryFolder folder;
  write_dataset(folder, 4);
  Image8 mask(16, 12, glm::u8vec4(255));  // twice the size
  mask.at(5, 4) = glm::u8vec4(0, 0, 0, 255);
  write_image(folder / "masks/b.png", mask);
  write_image(folder / "masks/c.png.png", mask);
  const Dataset dataset = read_dataset(folder / "");
  EXPECT_THAT(sentences(dataset), HasSubstr("Masks exclude pixels of 2 of 4 photographs"));
  for (const Photograph& photograph : dataset.train)
    if (photograph.camera.name != "d.png") {
      ASSERT_EQ(photograph.ignored.size(), 48u) << photograph.camera.name;
      EXPECT_EQ(std::ranges::count(photograph.ignored(), 1), 1);
      EXPECT_EQ(photograph.ignored()[2 * 8 + 2], 1);
    }
}

/// A panorama whose colours are the directions, in the axes of its camera: x right, y down, z
/// ahead.
Image8 sphere(int width) {
  Image8 image(width, width / 2);
  for (int y = 0; y < width / 2; ++y)
    for (int x = 0; x < width; ++x) {
      const double azimuth = 2 * M_PI * ((x + 0.5) / width - 0.5);
      const double elevation = M_PI * (0.5 - (y + 0.5) / (width / 2));
      const glm::dvec3 direction(std::cos(elevation) * std::sin(azimuth), -std::sin(elevation),
                                 std::cos(elevation) * std::cos(azimuth));
      image.at(x, y) = glm::u8vec4(glm::dvec4(127.5 + 120.0 * direction + 0.5, 255));
    }
  return image;
}

TEST(UsersDataset, APanoramaBecomesSixViews) {
  const TemporaryFolder folder;
  ColmapFixture model = upright_colmap(3);
  model.cameras[0] = {1, 17, "EQUIRECTANGULAR", 256, 128, {256, 128}};
  model.images[1].rotation[0] = model.images[1].rotation[1] = std::sqrt(0.5);
  write_text(folder / "sparse/0", model);
  for (const auto& image : model.images)
    write_image(folder / ("images/" + image.name), sphere(256));
  const Dataset dataset = read_dataset(folder / "");
  EXPECT_EQ(dataset.train.size() + dataset.test.size(), 18u);
  for (const auto* part : {&dataset.train, &dataset.test})
    for (const Photograph& view : *part) {
      SCOPED_TRACE(view.camera.name);
      ASSERT_EQ(view.camera.width, 64);
      EXPECT_EQ(view.camera.fx, 32);
      const auto& image = model.images[std::size_t(view.camera.name[0] - 'a')];
      const Image8 image_of = view.image();
      const glm::dmat3 camera_from_world = glm::mat3_cast(
          glm::dquat(image.rotation[0], image.rotation[1], image.rotation[2], image.rotation[3]));
      for (const glm::ivec2 at : {glm::ivec2(5, 9), glm::ivec2(32, 31), glm::ivec2(60, 40)}) {
        const glm::dvec3 ray((at.x + 0.5 - 32) / 32, -(at.y + 0.5 - 32) / 32, -1);
        const glm::dvec3 direction =
            glm::normalize(camera_from_world * (view.camera.world_from_view_rotation() * ray));
        for (int c = 0; c < 3; ++c)
          EXPECT_NEAR(image_of.at(at.x, at.y)[c], 127.5 + 120 * direction[c], 1.5);
      }
    }
}

// ---- Alpha ----------------------------------------------------------------------------------

Photograph opaque(int mark) {
  Photograph photograph;
  photograph.image = an_image(20, 10, mark);
  photograph.camera.width = 20;
  photograph.camera.height = 10;
  return photograph;
}

AlphaUse use_of(const std::vector<Photograph>& photographs) {
  std::vector<AlphaCounts> list;
  for (const Photograph& photograph : photographs) list.push_back(alpha_counts(photograph.image()));
  return alpha_of(list);
}

TEST(Alpha, IsBackgroundAroundObjectsAndAMaskElsewhere) {
  std::vector<Photograph> object, room, borders;
  for (int i = 0; i < 8; ++i) {
    Image8 object_image = opaque(i).image(), room_image = object_image, border_image = object_image;
    // The object fills the image in a third of the views.
    if (i % 3 > 0)
      for (int y = 0; y < 10; ++y)
        for (int x = 0; x < 20; ++x)
          if (x < 4 || x > 15 || y < 2 || y > 7) object_image.at(x, y).a = 0;
    for (int y = 3; y < 8; ++y)
      for (int x = i; x < i + 3; ++x) room_image.at(x, y).a = 0;
    // Borders that the removal of distortion leaves.
    for (int x = 0; x < 20; ++x) border_image.at(x, 0).a = border_image.at(x, 9).a = 0;
    object.push_back({.camera = {}, .image = object_image});
    room.push_back({.camera = {}, .image = room_image});
    borders.push_back({.camera = {}, .image = border_image});
  }
  EXPECT_EQ(use_of(object).meaning, AlphaMeaning::background);
  EXPECT_EQ(use_of(room).meaning, AlphaMeaning::mask);
  EXPECT_EQ(use_of(room).photographs, 8u);
  EXPECT_EQ(use_of(borders).meaning, AlphaMeaning::mask);
  EXPECT_EQ(use_of({opaque(0), opaque(1)}).meaning, AlphaMeaning::ignore);
  // Half-transparent pixels are no evidence.
  Photograph soft = opaque(0);
  Image8 half = soft.image();
  for (auto& pixel : half.pixels) pixel.a = 200;
  soft.image = half;
  EXPECT_EQ(use_of({soft, opaque(1)}).meaning, AlphaMeaning::ignore);
}

TEST(Alpha, IsAppliedAsItsMeaningSays) {
  Photograph photograph = opaque(0);
  Image8 image = photograph.image();
  image.at(3, 2).a = 0;
  image.at(4, 2).a = 252;
  photograph.image = image;
  Photograph background = photograph, mask = photograph, ignored = photograph;
  apply_alpha(AlphaMeaning::background, background);
  EXPECT_EQ(background.image().pixels, image.pixels);
  apply_alpha(AlphaMeaning::mask, mask);
  EXPECT_EQ(mask.image().pixels, opaque(0).image().pixels);
  ASSERT_EQ(mask.ignored.size(), 200u);
  EXPECT_EQ(std::ranges::count(mask.ignored(), 1), 1);
  EXPECT_EQ(mask.ignored()[2 * 20 + 3], 1);
  apply_alpha(AlphaMeaning::ignore, ignored);
  EXPECT_TRUE(ignored.ignored.empty());
  EXPECT_EQ(ignored.image().pixels, opaque(0).image().pixels);
}

TEST(Alpha, OfAPhotographInAFileAddsNoMoreThanItsMask) {
  const auto file = std::make_shared<ScratchFile>();
  Photograph mask = opaque(0);
  Image8 image = mask.image();
  image.at(3, 2).a = 0;
  mask.image = image;
  mask.move_to(file);
  Photograph ignored = mask;
  apply_alpha(AlphaMeaning::mask, mask);
  apply_alpha(AlphaMeaning::ignore, ignored);
  EXPECT_EQ(file->size(), (4 + 1) * 200u);
  EXPECT_EQ(mask.bytes(), (3 + 1) * 200u);
  EXPECT_EQ(mask.ignored.file(), file);
  EXPECT_EQ(std::ranges::count(mask.ignored(), 1), 1);
  for (const Photograph& each : {mask, ignored})
    EXPECT_EQ(each.image().pixels, opaque(0).image().pixels);
}

}  // namespace users_test
}  // namespace tureen
