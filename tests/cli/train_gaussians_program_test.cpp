// Program tests of `tureen train --method gaussians`, on photographs of a coloured ball, 32 pixels
// a side.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>

#include "formats/scene_file.hpp"
#include "image/video_file.hpp"
#include "tests/cli/train_fixture.hpp"
#include "tests/support/errors.hpp"
#include "trainer/common/training_log.hpp"

namespace tureen {
namespace train_gaussians_program_test {

using test::ChildResult;
using test::Names;
using testing::AllOf;
using testing::ElementsAre;
using testing::Not;
namespace fs = std::filesystem;

class TrainGaussians : public test::Train {
 protected:
  static std::vector<std::string> words(const std::string& output,
                                        const std::vector<std::string>& more = {}) {
    std::vector<std::string> all{"train",    "ball",      "-o",        output,
                                 "--method", "gaussians", "--threads", "2"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  ChildResult gaussians(const std::string& output,
                        const std::vector<std::string>& more = {}) const {
    return run(words(output, more));
  }
};

const Splats& splats_of(const Scene& scene) {
  return std::get<Splats>(only_layer(scene).primitives);
}

TEST_F(TrainGaussians, WritesTheSceneAndItsFiles) {
  make_dataset();
  const ChildResult result = gaussians(
      "ball.glb", {"--steps", "250", "--max-splats", "400", "--json", "--preview-every", "100"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  std::vector<std::string> expected{"ball.glb", "ball.jsonl", "ball.previews/step_100.png",
                                    "ball.previews/step_200.png", "ball.previews/step_250.png"};
  if (have_ffmpeg()) expected.insert(expected.begin(), "ball-previews.mp4");
  EXPECT_EQ(files(), expected);
  // The forecast, before the first step.
  EXPECT_THAT(result.err, Names("forecast", "MiB", 400, "splats"));

  const auto json = nlohmann::ordered_json::parse(result.out);
  EXPECT_THAT(keys(json), ElementsAre("done", "steps", "seconds", "splats", "test",
                                      "trainer_psnr_db", "non_finite", "output"));
  EXPECT_EQ(json["steps"], 250);
  EXPECT_EQ(json["non_finite"], 0);
  EXPECT_EQ(json["test"]["views"], 2);
  // The bound allows for two renderers and for rounding to bytes.
  EXPECT_NEAR(json["test"]["psnr_db"].get<double>(), json["trainer_psnr_db"].get<double>(), 0.1);
  // 17.0 dB when written. Other processors round differently.
  EXPECT_GT(json["trainer_psnr_db"], 15);

  const Scene scene = read_scene(folder / "ball.glb");
  EXPECT_EQ(scene.info.source, "Tureen trainer, 250 steps");
  EXPECT_EQ(scene.info.name, "ball");
  EXPECT_EQ(scene.info.background, glm::vec3(1));
  EXPECT_EQ(scene.cameras.size(), 8u);
  EXPECT_EQ(count(splats_of(scene)), json["splats"].get<std::size_t>());
  EXPECT_LE(count(splats_of(scene)), 400u);
  EXPECT_EQ(profile_name(splats_of(scene)), "3dgs");
  const auto log = trainer::read_training_log(folder / "ball.jsonl");
  EXPECT_EQ(log.back().primitives.kind, trainer::PrimitiveKind::splats);
  EXPECT_EQ(run({"report", "ball.jsonl", "-o", "report.html"}).exit_code, 0);
}

TEST_F(TrainGaussians, TrianglesAreSoftOrOpaque) {
  make_dataset();
  const auto train = [&](const std::string& output, const std::vector<std::string>& more) {
    std::vector<std::string> all{"train", "ball", "-o", output, "--method", "triangles"};
    all.insert(all.end(), {"--steps", "200", "--max-splats", "400", "--threads", "2", "--json"});
    all.insert(all.end(), more.begin(), more.end());
    const ChildResult result = run(all);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    // 19 dB or more when written, opaque 18. Other processors round differently.
    EXPECT_GT(nlohmann::json::parse(result.out)["test"]["psnr_db"], 13) << output;
    return read_scene(folder / output);
  };
  const Scene soft = train("soft.glb", {});
  EXPECT_EQ(profile_name(splats_of(soft)), "triangle-splatting");
  EXPECT_LE(count(splats_of(soft)), 400u);
  const Scene opaque = train("opaque.glb", {"--opaque"});
  const TriangleSoup& soup = only_soup(opaque);
  EXPECT_GT(soup.triangles.size(), 20u);
  EXPECT_TRUE(std::holds_alternative<Harmonics>(soup.appearance));
  EXPECT_THAT(run({"train", "ball", "-o", "x.glb", "--opaque"}).err,
              Names("--opaque", "--method triangles"));
}

TEST_F(TrainGaussians, ResumesAfterCtrlCWithTheSameBits) {
  make_dataset();
  fs::create_directories(folder / "whole");
  const std::vector<std::string> more{"--steps", "3000", "--max-splats", "300"};
  ASSERT_EQ(gaussians("whole/ball.glb", more).exit_code, 0);
  {
    test::Child child(words("ball.glb", more), folder);
    ASSERT_TRUE(child.wait_until([&] { return !bytes("ball.jsonl").empty(); }));
    child.signal(SIGINT);
    const ChildResult result = child.wait();
    ASSERT_EQ(result.exit_code, 5) << result.err;
    EXPECT_THAT(result.err, Names("ball.checkpoint", "3,000", "--resume"));
  }
  const auto refused = [&](const std::vector<std::string>& changed, const auto&... values) {
    const ChildResult result = gaussians("ball.glb", changed);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_THAT(result.err, Names(values...));
  };
  refused({}, "ball.checkpoint");
  refused({"--resume", "--seed", "3"}, "seed", 3, 0);
  refused({"--resume", "--max-splats", "301"}, "max_splats", 301, 300);
  refused({"--resume", "--scale", "0.5"}, "r_0.png", 16, 32);
  // The checkpoint of another method.
  EXPECT_EQ(run({"train", "ball", "-o", "ball.glb", "--resume"}).exit_code, 3);

  // Without options, the constants are those of the checkpoint; other threads, the same bits.
  const ChildResult result = run(
      {"train", "ball", "-o", "ball.glb", "--method", "gaussians", "--resume", "--threads", "1"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(bytes("ball.glb"), bytes("whole/ball.glb"));
  EXPECT_FALSE(exists("ball.checkpoint"));
}

TEST_F(TrainGaussians, BeginsWithGaussiansOrTriangles) {
  make_dataset();
  ASSERT_EQ(gaussians("a.glb", {"--steps", "60", "--max-splats", "200"}).exit_code, 0);
  const ChildResult on = gaussians("b.glb", {"--steps", "1", "--init", "a.glb", "--json"});
  ASSERT_EQ(on.exit_code, 0) << on.err;
  EXPECT_EQ(count(splats_of(read_scene(folder / "b.glb"))),
            count(splats_of(read_scene(folder / "a.glb"))));
  write_scene();
  const ChildResult mesh =
      gaussians("c.glb", {"--steps", "1", "--init", "scene.off", "--max-splats", "50", "--json"});
  ASSERT_EQ(mesh.exit_code, 0) << mesh.err;
  EXPECT_EQ(nlohmann::json::parse(mesh.out)["splats"], 50);
}

TEST_F(TrainGaussians, ReadsConstantsFromFileAndOptions) {
  make_dataset(false);
  write("few.json", R"({"steps": 30, "max_splats": 60, "seed": 5, "degree": 1})");
  const auto print = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all{"train", "ball", "--method", "gaussians", "--print-config"};
    all.insert(all.end(), more.begin(), more.end());
    const ChildResult result = run(all);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return nlohmann::json::parse(result.out);
  };
  EXPECT_EQ(print({})["background"], nlohmann::json({0, 0, 0}));  // no alpha
  const auto mixed = print({"--config", "few.json", "--max-splats", "40", "--init", "random"});
  EXPECT_EQ(mixed["steps"], 30);
  EXPECT_EQ(mixed["max_splats"], 40);
  EXPECT_EQ(mixed["degree"], 1);
  EXPECT_EQ(mixed["initialisation"], "random");
  EXPECT_EQ(print({"--minutes", "2.5"})["minutes"], 2.5);
  // Less memory, fewer splats.
  const std::uint64_t some = print({"--max-memory", "90MiB"})["max_splats"];
  EXPECT_LT(some, 60'000u);
  EXPECT_GT(some, 1000u);
  EXPECT_LT(print({"--max-memory", "80MiB"})["max_splats"].get<std::uint64_t>(), some);
  const ChildResult list = run({"train", "--method", "gaussians", "--list-config"});
  EXPECT_EQ(list.exit_code, 0);
  EXPECT_THAT(list.out,
              AllOf(testing::HasSubstr("max_splats: 60000"), Not(testing::HasSubstr("min_level"))));
  EXPECT_THAT(run({"train", "--list-config"}).out, testing::HasSubstr("min_level"));
}

TEST_F(TrainGaussians, FitsItsStepsToTheMinutes) {
  make_dataset();
  const ChildResult result =
      gaussians("ball.glb", {"--minutes", "0.03", "--max-splats", "300", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_NE(json["steps"], 5000);
  // 1.8 s; the machine may be busy in a part of the run.
  EXPECT_GT(json["seconds"], 0.4);
}

TEST_F(TrainGaussians, ReportsWrongUsageAndInputs) {
  make_dataset();
  const auto expect = [&](const std::vector<std::string>& more, int code, const auto&... values) {
    const ChildResult result = gaussians("b.glb", more);
    EXPECT_EQ(result.exit_code, code) << result.err;
    EXPECT_THAT(result.err, Names(values...));
  };
  expect({"--level", "2"}, 2, "--level", "diffsoup");
  expect({"--preset", "scene"}, 2, "--preset", "diffsoup");
  expect({"--triangles", "100"}, 2, "--triangles", "--max-splats");
  expect({"--export-diffsoup", "web"}, 2, "--export-diffsoup");
  expect({"--steps", "5", "--minutes", "1"}, 2, "--steps", "--minutes");
  expect({"--max-splats", "0"}, 2, "max_splats", 0, 1);
  expect({"--max-splats", "-3"}, 2, "max_splats", -3);
  expect({"--minutes", "-1"}, 2, "minutes", -1);
  expect({"--max-memory", "16MiB"}, 2, "--max-memory");
  expect({"--init", "points"}, 3, "points");
  expect({"--init", "pionts"}, 3, "pionts", "points");
  write("bad.json", R"({"max_splat": 3})");
  expect({"--config", "bad.json"}, 3, "bad.json", "max_splat", "max_splats");
  write("mesh.json", R"({"initialisation": "mesh"})");
  expect({"--config", "mesh.json"}, 2, "--init", "FILE");
  expect({"--resume"}, 3, "b.checkpoint");
  const ChildResult method = run({"train", "ball", "-o", "b.glb", "--method", "gausians"});
  EXPECT_EQ(method.exit_code, 2);
  EXPECT_THAT(method.err, Names("gausians", "gaussians"));
  const ChildResult soup = train("b.glb", {"--max-splats", "100"});
  EXPECT_EQ(soup.exit_code, 2);
  EXPECT_THAT(soup.err, Names("--max-splats", "gaussians"));
  EXPECT_FALSE(exists("b.glb"));
}

}  // namespace train_gaussians_program_test
}  // namespace tureen
