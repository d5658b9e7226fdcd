#include "formats/dataset/bundler.hpp"

#include <glm/geometric.hpp>

#include "formats/dataset/dataset.hpp"
#include "formats/dataset/dataset_remarks.hpp"
#include "tests/formats/dataset/dataset_fixture.hpp"
#include "tests/formats/format_testing.hpp"
#include "tests/formats/truncation.hpp"

namespace tureen {
namespace bundler_test {

using namespace tureen::test;
using ::testing::ElementsAre;

/// Two cameras, and one that the reconstruction does not have. The first looks from (0, 0, 5) along
/// -z, the second from (4, 0, 0) along -x.
const std::string model =
    "# Bundle file v0.3\n"
    "3 2\n"
    "10.5 -0.02 0.001\n1 0 0\n0 1 0\n0 0 1\n0 0 -5\n"
    "0 0 0\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n"
    "1.2e1 0 0\n0 0 -1\n0 1 0\n1 0 0\n0 0 -4\n"
    "1 2 -3.5\n255 128 0\n2 0 7 1.5 -2.5 2 9 1 1\n"
    "0 0 0\n1 2 3\n0\n";

BundlerModel read(const std::string& text) {
  Input input = input_of(text, "bundle.out");
  return read_bundler(input);
}

TEST(Bundler, ReadsCamerasAndPoints) {
  const BundlerModel result = read(model);
  ASSERT_EQ(result.cameras.size(), 3u);
  EXPECT_EQ(result.cameras[0].focal, 10.5);
  EXPECT_EQ(result.cameras[0].lens, brown({.k1 = -0.02, .k2 = 0.001}));
  EXPECT_EQ(result.cameras[0].view_from_world[3], glm::dvec4(0, 0, -5, 1));
  EXPECT_EQ(result.cameras[1].focal, 0);
  // The point ahead of the second camera is at negative z in its view.
  const glm::dvec4 ahead = result.cameras[2].view_from_world * glm::dvec4(1, 0, 0, 1);
  EXPECT_LT(glm::length(ahead - glm::dvec4(0, 0, -3, 1)), 1e-12);
  ASSERT_EQ(result.points.size(), 2u);
  EXPECT_EQ(result.points[0].position, glm::dvec3(1, 2, -3.5));
  EXPECT_EQ(result.points[0].color, glm::u8vec3(255, 128, 0));
  EXPECT_EQ(result.points[1].color, glm::u8vec3(1, 2, 3));
}

TEST(Bundler, ReadsListsWithAndWithoutFocalLengths) {
  const std::string list = "a.jpg 0 2100.5\r\n\nsub/b c.jpg\nd.jpg 0 1\n0 1\nmy 0 e.jpg\nf 0 inf\n";
  Input input = input_of(list, "list.txt");
  EXPECT_THAT(read_bundler_list(input),
              ElementsAre("a.jpg", "sub/b c.jpg", "d.jpg", "0 1", "my 0 e.jpg", "f 0 inf"));
}

TEST(Bundler, LinesOfAListHaveALimit) {
  const auto read_list = [](const std::string& text) {
    Input input = input_of(text, "list.txt");
    return read_bundler_list(input);
  };
  std::string words;
  for (int i = 0; i < 2048; ++i) words += "a ";
  EXPECT_EQ(read_list(words + "\nb").size(), 2u);
  EXPECT_THAT(error_of([&] { read_list("b\n" + words + "a a"); }), ErrorAt("list.txt:2", 4096));
}

TEST(Bundler, NamesTheLineOfEachError) {
  const auto with = [](const std::string& from, const std::string& to) {
    std::string text = model;
    text.replace(text.find(from), from.size(), to);
    return error_of([&] { read(text); });
  };
  EXPECT_THAT(with("v0.3", "v0.1"), ErrorAt("bundle.out:1", "v0.3"));
  EXPECT_THAT(with("# B", "B"), ErrorAt("bundle.out:1"));
  EXPECT_THAT(with("3 2", "3000000 2"), ErrorAt("bundle.out:2", 3000000));
  EXPECT_THAT(with("3 2", "3 -2"), ErrorAt("bundle.out:2"));
  EXPECT_THAT(with("10.5", "-10.5"), ErrorAt("bundle.out:3"));
  EXPECT_THAT(with("10.5", "inf"), ErrorAt("bundle.out:3", "inf"));
  EXPECT_THAT(with("10.5", "10,5"), ErrorAt("bundle.out:3", "10,5"));
  EXPECT_THAT(with("1 0 0\n0 1 0\n", "2 0 0\n0 1 0\n"), ErrorAt("bundle.out:7", "rotation"));
  EXPECT_THAT(with("1 0 0\n0 1 0\n", "-1 0 0\n0 1 0\n"), ErrorAt("bundle.out:7", "mirrors"));
  EXPECT_THAT(with("255 128", "256 128"), ErrorAt("bundle.out:19", 256));
  EXPECT_THAT(with("2 0 7", "1 0 7"), ErrorAt("bundle.out:20", "views"));
  EXPECT_THAT(with("2 0 7", "3 0 7"), ErrorAt("bundle.out:20", "view"));
  EXPECT_THAT(with("2 0 7", "4000000 0 7"), ErrorAt("bundle.out:20", 4000000));
  EXPECT_THAT(with("2 0 7", "2 x 7"), ErrorAt("bundle.out:20", "x"));
}

TEST(Bundler, SurvivesTruncation) {
  const auto bytes = std::as_bytes(std::span(std::string_view(model)));
  const std::vector<std::byte> whole(bytes.begin(), bytes.end());
  survive_truncation(whole, [](std::span<const std::byte> part) {
    Input input = Input::memory("bundle.out", part);
    read_bundler(input);
  });
}

TEST(Bundler, UpIsYIfItsCamerasDisagree) {
  const TemporaryFolder folder;
  std::string text = model;
  const std::string sideways = "0 0 -1\n0 1 0\n1 0 0\n";
  text.replace(text.find(sideways), sideways.size(), "-1 0 0\n0 -1 0\n0 0 1\n");
  write_text(folder / "bundle.out", text);
  write_text(folder / "list.txt", "a.png\nlost.png\nb.png\n");
  for (const char* name : {"a.png", "b.png"}) write_image(folder / name, an_image(8, 6));
  const Dataset dataset = read_dataset(folder / "");
  EXPECT_EQ(dataset.up, glm::vec3(0, 1, 0));
  EXPECT_THAT(dataset.remarks,
              ::testing::Contains(Remark{&remarks::up_of_no_camera, {{"axis", "y"}}}));
}

TEST(Bundler, IsADataset) {
  const TemporaryFolder folder;
  write_text(folder / "bundle/bundle.out", model);
  write_text(folder / "list.txt", "a.png 0 10\nimages/lost.png\n./b.png\n");
  // Sizes may differ: the focal length is in pixels. Images may be in images/.
  write_image(folder / "a.png", Image8(80, 60, glm::u8vec4(9, 8, 7, 255)));
  write_image(folder / "images/b.png", an_image(6, 8));
  EXPECT_TRUE(is_dataset(folder / ""));
  const Dataset dataset = read_dataset(folder / "");
  ASSERT_EQ(dataset.test.size(), 1u);
  ASSERT_EQ(dataset.train.size(), 1u);
  const Camera& b = dataset.test[0].camera;
  EXPECT_EQ(b.name, "./b.png");
  EXPECT_EQ(b.fx, 12);
  EXPECT_EQ(b.fy, 12);
  EXPECT_EQ(b.cx, 3);
  EXPECT_EQ(b.cy, 4);
  EXPECT_LT(glm::length(b.eye() - glm::dvec3(4, 0, 0)), 1e-12);
  EXPECT_EQ(dataset.train[0].camera.name, "a.png");
  EXPECT_EQ(dataset.points.size(), 2u);
  EXPECT_EQ(dataset.up, glm::vec3(0, 1, 0));
  const DatasetSummary summary = read_dataset_summary(folder / "");
  EXPECT_EQ(summary.train[0].camera.width, 80);
  EXPECT_EQ(summary.test[0].camera.width, 6);

  const auto refused = [&] { return error_of([&] { read_dataset(folder / ""); }); };
  write_text(folder / "list.txt", "a.png\n");
  EXPECT_THAT(refused(), ErrorIn("list.txt", 1, 3));
  std::filesystem::remove(folder / "list.txt");
  EXPECT_THAT(refused(), ErrorIn("bundle.out", "list.txt"));
}

}  // namespace bundler_test
}  // namespace tureen
