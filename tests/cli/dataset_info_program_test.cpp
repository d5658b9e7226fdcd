// Program tests of `tureen info` on a dataset.
#include <gmock/gmock.h>

#include "tests/cli/program_fixture.hpp"
#include "tests/formats/dataset/dataset_fixture.hpp"

namespace tureen {
namespace dataset_info_program_test {

using test::ChildResult;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

class DatasetInfo : public test::Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    std::filesystem::create_directories(folder / "data/images");
    std::string frames;
    for (int i = 0; i < 4; ++i) {
      const std::string name = "images/" + std::to_string(i) + ".png";
      write_png("data/" + name, Image8(i == 3 ? 16 : 20, 12, glm::u8vec4(90, 80, 70, 255)));
      frames += (i ? ", " : "") + std::string("{\"file_path\": \"") + name + "\", " +
                (i == 3 ? "\"w\": 16, " : "") + (i == 2 ? "\"is_fisheye\": true, " : "") +
                (i == 1 ? "\"k1\": 0.01, " : "") + "\"transform_matrix\": [[1,0,0," +
                std::to_string(3 * i) + "],[0,0,-1,4],[0,1,0,1],[0,0,0,1]]}";
    }
    write("data/transforms.json",
          R"({"fl_x": 20, "w": 20, "h": 12, "ply_file_path": "points.ply", "frames": [)" + frames +
              "]}");
    write("data/points.ply",
          "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
          "property float z\nend_header\n1 2 3\n4 6 1\n");
  }
};

TEST_F(DatasetInfo, PrintsWhatTheReaderUnderstood) {
  const ChildResult result = run({"info", "data", "-o", "plot.svg", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(
      result.err,
      AllOf(HasSubstr("data: a dataset"), HasSubstr("3 to train on, 1 to test"),
            HasSubstr("16 x 12 (1), 20 x 12 (3)"),
            HasSubstr(
                "2 without distortion; 1 with distortion, to be removed; 1 with a fisheye lens"),
            HasSubstr("(0, 4, 1) to (9, 4, 1)"), HasSubstr("(1, 2, 1) to (4, 6, 3)"),
            HasSubstr("The up axis is assumed to be z")));
  const auto json = nlohmann::ordered_json::parse(result.out);
  EXPECT_THAT(keys(json),
              ElementsAre("file", "train_photographs", "test_photographs", "image_sizes", "lenses",
                          "masks", "camera_bounds", "extent", "points", "point_bounds", "up",
                          "cameras", "notes", "remarks", "output"));
  EXPECT_EQ(json["train_photographs"], 3);
  EXPECT_EQ(json["extent"], 9);
  EXPECT_EQ(json["points"], 2);
  EXPECT_EQ(json["cameras"].size(), 4u);
  EXPECT_EQ(json["cameras"][3]["name"], "images/0.png");  // the test view is last
  EXPECT_EQ(json["output"], "plot.svg");
  std::ifstream stream(folder / "plot.svg");
  const std::string svg{std::istreambuf_iterator<char>(stream), {}};
  EXPECT_TRUE(svg.starts_with("<svg ")) << svg.substr(0, 40);
  EXPECT_THAT(svg, AllOf(HasSubstr("from above"), HasSubstr("from the side"),
                         HasSubstr("3 to train on"), testing::EndsWith("</svg>\n")));
  std::size_t lines = 0;
  for (std::size_t at = 0; (at = svg.find("<line ", at)) != std::string::npos; ++at) ++lines;
  EXPECT_EQ(lines, 2u * 4);
  EXPECT_EQ(run({"info", "data/transforms.json"}).exit_code, 0);
}

TEST_F(DatasetInfo, NamesWhatIsWrong) {
  write_scene();
  const auto expect = [&](const std::vector<std::string>& arguments, int code, const char* word) {
    const ChildResult result = run(arguments);
    EXPECT_EQ(result.exit_code, code) << word;
    EXPECT_THAT(result.err, HasSubstr(word));
  };
  expect({"info", "scene.off", "-o", "plot.svg"}, 2, "dataset");
  expect({"info", "dat", "-o", "plot.svg"}, 3, "dat");
  expect({"info", "data", "scene.off"}, 2, "'data' is a dataset");
  expect({"info", "data", "--strict"}, 2, "--json, -o and --max-memory");
  expect({"info", "data", "--up", "0,1,0"}, 2, "--json, -o and --max-memory");
  expect({"info", "data", "-o", "plot.png"}, 2, ".svg");
  expect({"info", "data", "-o", "nowhere/plot.svg"}, 5, "nowhere");
  expect({"info", "data/images"}, 3, ("tureen info " + (folder / "data").string()).c_str());
  expect({"info", "data/images/"}, 3, "tureen cameras data/images/ finds the cameras");
  std::filesystem::remove(folder / "data/images/2.png");
  expect({"info", "data"}, 0, "1 of 4 photographs was skipped (images/2.png): the file is missing");
  EXPECT_FALSE(exists("plot.svg"));
}

TEST_F(DatasetInfo, NamesAModelWithoutPhotographs) {
  test::write_text(folder / "model/sparse/0", test::upright_colmap(4));
  const ChildResult result = run({"info", "model"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err,
              HasSubstr("a COLMAP model with 1 camera, 4 images and 1 point, which is no dataset"));
}

}  // namespace dataset_info_program_test
}  // namespace tureen
