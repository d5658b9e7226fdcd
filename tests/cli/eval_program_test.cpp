// Program tests of `tureen eval`, against photographs that the program drew from the scene itself.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "formats/scene_file.hpp"
#include "formats/tureen_glb/tureen_glb.hpp"
#include "tests/cli/photographs_fixture.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/random_splats.hpp"

namespace tureen {
namespace eval_program_test {

using test::ChildResult;
using test::Names;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;

const std::string example = TUREEN_SOURCE_DIR "/examples/soup.glb";

class Eval : public test::ProgramWithPhotographs {
 protected:
  ChildResult eval(std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{"eval", example, "data", "--context", "osmesa", "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
};

TEST_F(Eval, TheScenesOwnImagesAreMetExactly) {
  photograph(example);
  const ChildResult result = eval({"-o", "views"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::ordered_json::parse(result.out);
  EXPECT_THAT(keys(json), ElementsAre("views", "mean", "scene", "dataset", "split", "scale",
                                      "samples_per_pixel", "ssim_border", "context", "renderer",
                                      "plan", "specialisations", "output"));
  ASSERT_EQ(json["views"].size(), 2u);
  EXPECT_THAT(keys(json["views"][0]),
              ElementsAre("name", "psnr_db", "ssim", "flip", "holes", "specks"));
  EXPECT_EQ(json["views"][1]["name"], "test/r_1.png");
  for (const auto& view : json["views"]) {
    EXPECT_EQ(view["psnr_db"], 100);
    EXPECT_NEAR(view["ssim"].get<double>(), 1, 1e-12);
    EXPECT_EQ(view["flip"], 0);
  }
  EXPECT_EQ(json["mean"]["psnr_db"], 100);
  EXPECT_EQ(json["split"], "test");
  EXPECT_EQ(json["ssim_border"], "valid");
  EXPECT_EQ(json["output"], nlohmann::ordered_json({"views/test_r_0.png", "views/test_r_1.png",
                                                    "views/contact_sheet.png", "views/eval.json",
                                                    "views/report.html"}));
  for (const auto& file : json["output"]) EXPECT_TRUE(exists(file)) << file;
  const Image8 sheet = read_png("views/test_r_1.png"), photograph = read_png("data/test/r_1.png");
  EXPECT_EQ(sheet.width, 4 * width);
  int holes = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      ASSERT_EQ(sheet.at(x, y), photograph.at(x, y));
      ASSERT_EQ(sheet.at(width + x, y), photograph.at(x, y));
      ASSERT_EQ(sheet.at(2 * width + x, y), glm::u8vec4(0, 0, 0, 255));
      // The photograph is opaque everywhere, so its background counts as a hole.
      const glm::u8vec4 marked = sheet.at(3 * width + x, y);
      const bool is_hole = marked == glm::u8vec4(255, 0, 255, 255);
      holes += is_hole;
      for (int c = 0; c < 3 && !is_hole; ++c)
        ASSERT_NEAR(marked[c], 0.4 * photograph.at(x, y)[c], 0.51);
    }
  EXPECT_GT(holes, 0);
  EXPECT_LT(holes, width * height);
  EXPECT_THAT(result.err, Names("test/r_1.png", "100.00"));
}

class EvalOfSplats : public Eval {
 protected:
  /// A layer of random splats beside the triangles of write_scene(), which stand in its middle.
  void write_splats(const test::SplatKind& kind, std::uint64_t seed = 1) const {
    Scene scene = scene_of(test::random_splats(kind, 300, 0.2, seed));
    write_scene();
    scene.layers.push_back(read_scene(folder / "scene.off").layers.front());
    write_tureen_glb(scene, folder / "splats.glb");
  }
  /// The mean PSNR of splats.glb in dB.
  double psnr() const {
    const ChildResult result = run({"eval", "splats.glb", "data", "--no-flip", "--context",
                                    "osmesa", "--json", "--split", "all"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.err, Names("300 splats", "3 triangles"));
    return nlohmann::json::parse(result.out)["mean"]["psnr_db"];
  }
};

TEST_F(EvalOfSplats, TheScenesOwnImagesAreMetExactlyAndOthersAreNot) {
  for (const test::SplatKind& kind : test::splat_kinds) {
    SCOPED_TRACE(kind.name);
    write_splats(kind);
    photograph("splats.glb");
    EXPECT_EQ(psnr(), 100);
    write_splats(kind, 2);
    EXPECT_LT(psnr(), 30);
  }
}

TEST_F(EvalOfSplats, WindowsAreBlendedUnlessOpaque) {
  write_splats(test::splat_kinds[0]);
  photograph("splats.glb");
  std::vector<std::string> arguments{"eval",   "splats.glb", "data",   "--context",
                                     "osmesa", "--opaque",   "--json", "--no-flip"};
  const ChildResult opaque = run(arguments);
  ASSERT_EQ(opaque.exit_code, 0) << opaque.err;
  EXPECT_LT(nlohmann::json::parse(opaque.out)["mean"]["psnr_db"], 30);
  EXPECT_THAT(opaque.err, Not(testing::HasSubstr("splats against")));
  write_splats(test::splat_kinds[1]);
  const ChildResult refused = run(arguments);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, Names("layer 1", "Gaussians"));
}

TEST_F(Eval, AKnownErrorHasItsDecibels) {
  photograph(example);
  Image8 photograph = read_png("data/test/r_0.png");
  for (glm::u8vec4& pixel : photograph.pixels) pixel.r ^= 8;  // 8 more or less, without clamping
  write_png("data/test/r_0.png", photograph);
  const auto json = nlohmann::json::parse(eval().out);
  const double expected = -10 * std::log10(std::pow(8.0 / 255, 2) / 3);  // one channel of three
  EXPECT_NEAR(json["views"][0]["psnr_db"].get<double>(), expected, 1e-4);
  EXPECT_GT(json["views"][0]["flip"].get<double>(), 0);
  EXPECT_LT(json["views"][0]["ssim"].get<double>(), 1);
  // The mean is a mean in decibels, not the decibels of a mean.
  EXPECT_NEAR(json["mean"]["psnr_db"].get<double>(), (expected + 100) / 2, 1e-4);
}

TEST_F(Eval, TakesTheSplitTheScaleAndTheBackground) {
  photograph(example);
  const auto train = nlohmann::json::parse(eval({"--split", "train", "--no-flip"}).out);
  ASSERT_EQ(train["views"].size(), 1u);
  EXPECT_EQ(train["views"][0]["name"], "train/r_0.png");
  EXPECT_FALSE(train["views"][0].contains("flip"));
  EXPECT_FALSE(train["mean"].contains("flip"));
  const ChildResult all = eval({"--split", "all", "--scale", "0.5", "-o", "views"});
  ASSERT_EQ(all.exit_code, 0) << all.err;
  EXPECT_EQ(nlohmann::json::parse(all.out)["views"].size(), 3u);
  EXPECT_EQ(read_png("views/train_r_0.png").width, 4 * width / 2);

  // Only the background is visible on both sides, so they are equal on any background.
  write("far.off", "COFF\n3 1 0\n900 900 0\n901 900 0\n900 901 0\n3 0 1 2 255 0 0\n");
  for (const char* name : {"data/test/r_0.png", "data/test/r_1.png"})
    write_png(name, Image8(width, height, glm::u8vec4(255, 0, 0, 0)));
  const ChildResult clear =
      run({"eval", "far.off", "data", "--context", "osmesa", "--json", "--background", "0,1,0.2"});
  ASSERT_EQ(clear.exit_code, 0) << clear.err;
  EXPECT_EQ(nlohmann::json::parse(clear.out)["mean"]["psnr_db"], 100);
  for (const char* name : {"data/test/r_0.png", "data/test/r_1.png"})
    write_png(name, Image8(width, height, glm::u8vec4(255)));
  const auto opaque = nlohmann::json::parse(
      run({"eval", "far.off", "data", "--context", "osmesa", "--json", "--background", "black"})
          .out);
  EXPECT_NEAR(opaque["mean"]["psnr_db"].get<double>(), 0, 1e-9);
}

TEST_F(Eval, ExitCodesSayWhoIsToBlame) {
  photograph(example);
  const auto expect = [&](const std::vector<std::string>& arguments, int code,
                          const auto&... values) {
    const ChildResult result = run(arguments);
    EXPECT_EQ(result.exit_code, code);
    EXPECT_THAT(result.err, Names(values...));
    EXPECT_THAT(result.out, IsEmpty());
  };
  expect({"eval", example}, 2, "DATASET");
  expect({"eval", example, "data", "--scale", "0"}, 2, "--scale", 0);
  expect({"eval", example, "data", "--scale", "1.5"}, 2, "--scale", 1.5);
  expect({"eval", example, "data", "--split", "tets"}, 2, "tets", "test");
  expect({"eval", example, "data", "--background", "pinkish"}, 2, "pinkish");
  expect({"eval", example, "data", "--context", "osmesa", "--scale", "0.1"}, 3, "6 x 5", 11);
  expect({"eval", example, "data", "--background", "transparent"}, 2, "0.2,0.4,1");
  expect({"eval", example, "dat"}, 3, "dat", "data");
  expect({"eval", "soup.glb", "data"}, 3, "soup.glb");
  write("file", "");
  expect({"eval", example, "data", "--context", "osmesa", "-o", "file"}, 5, "file");
  std::filesystem::remove(folder / "data/test/r_1.png");
  expect({"eval", example, "data", "--context", "osmesa", "-o", "views"}, 3, "r_1.png");
  EXPECT_FALSE(exists("views"));
}

TEST_F(Eval, DoesNotReplaceThePhotographsOfTheDataset) {
  photograph(example);
  std::filesystem::copy_file(folder / "data/test/r_0.png", folder / "data/test_r_0.png");
  const ChildResult refused = eval({"-o", "data"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, Names("data/test_r_0.png"));
  EXPECT_EQ(read_png("data/test_r_0.png").pixels, read_png("data/test/r_0.png").pixels);
  EXPECT_FALSE(exists("data/test_r_1.png"));
  EXPECT_EQ(eval({"-o", "data/views"}).exit_code, 0);
  EXPECT_TRUE(exists("data/views/test_r_0.png"));
}

TEST_F(Eval, WithoutAContextItSaysSo) {
  photograph(example);
  // With this variable, the loader of EGL drivers finds no driver.
  ::setenv("__EGL_VENDOR_LIBRARY_FILENAMES", (folder / "none.json").c_str(), 1);
  const ChildResult result = run({"eval", example, "data", "--context", "egl", "-o", "views"});
  ::unsetenv("__EGL_VENDOR_LIBRARY_FILENAMES");
  if (result.exit_code == 0) GTEST_SKIP() << "this EGL has no loader that could fail";
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_THAT(result.err, Names("EGL"));
}

TEST_F(Eval, TwoScenesAreComparedOnTheSamePhotographs) {
  photograph(example);
  const std::vector<std::string> same{"compare", example, example, "data", "--context", "osmesa"};
  std::vector<std::string> arguments = same;
  arguments.insert(arguments.end(), {"-o", "report", "--json", "--split", "all"});
  const ChildResult result = run(arguments);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["a"]["views"], json["b"]["views"]);
  EXPECT_EQ(json["a"]["mean"]["psnr_db"], 100);
  EXPECT_EQ(json["a"]["scale"], 1);
  EXPECT_EQ(json["a"]["samples_per_pixel"], 1);
  ASSERT_EQ(json["a"]["pairs"].size(), json["a"]["views"].size());
  // Photograph, A, B, and black: both are equal.
  const Image8 pair = read_png(json["a"]["pairs"][0]);
  ASSERT_EQ(pair.width, 4 * width);
  for (int x = 0; x < width; ++x) {
    EXPECT_EQ(pair.at(width + x, height / 2), pair.at(2 * width + x, height / 2));
    EXPECT_EQ(pair.at(3 * width + x, height / 2), glm::u8vec4(0, 0, 0, 255));
  }
  EXPECT_EQ(run({"report", "report/compare.json", "-o", "again.html"}).exit_code, 0);
  EXPECT_THAT(result.err, Names("--scale 1", "one sample per pixel", "+0.00"));
  ASSERT_EQ(run({"convert", example, "smooth.glb", "--supersample", "2"}).exit_code, 0);
  arguments = same;
  arguments[2] = "smooth.glb";
  EXPECT_THAT(run(arguments).err,
              Names("one sample per pixel", "B stores another", "2 x 2 samples"));
  // Each kind of input has its own options.
  const auto expect = [&](const std::vector<std::string>& words, int code, const auto&... values) {
    const ChildResult wrong = run(words);
    EXPECT_EQ(wrong.exit_code, code) << wrong.err;
    EXPECT_THAT(wrong.err, Names(values...));
  };
  expect({"compare", example, example}, 2, "DATASET");
  expect({"compare", example, example, "data", "--tolerance", "1"}, 2, "--tolerance");
  expect({"compare", "data/test/r_0.png", "data/test/r_0.png", "-o", "x"}, 2, "-o", "--diff");
  expect({"report", example}, 3, "soup.glb", "scene", ".jsonl", "tureen eval");
  expect({"eval", example, "data/test"}, 3, "data", "did you mean");
}

}  // namespace eval_program_test
}  // namespace tureen
