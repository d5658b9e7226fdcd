// Program tests of `tureen train --method gaussians`, on photographs of a coloured ball, 32 pixels
// a side.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>

#include "base/decimal_text.hpp"
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
  std::vector<std::string> expected{"ball.glb", "ball.jsonl", "ball.previews/step_00000100.png",
                                    "ball.previews/step_00000200.png",
                                    "ball.previews/step_00000250.png"};
  if (have_ffmpeg()) expected.insert(expected.begin(), "ball-previews.mp4");
  EXPECT_EQ(files(), expected);
  // The plan, before the first step.
  EXPECT_THAT(result.err, Names("MiB", 250, "steps", 400, "splats"));
  const std::string log_text = bytes("ball.jsonl");
  const auto plan = nlohmann::json::parse(log_text.substr(0, log_text.find('\n')))["plan"];
  EXPECT_EQ(plan["method"], "gaussians");
  EXPECT_EQ(plan["last"], 400);
  EXPECT_EQ(plan["constants"]["steps"], 250);
  EXPECT_THAT(result.err, testing::HasSubstr(plan["text"].back().get<std::string>()));

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
    all.insert(all.end(), {"--steps", "600", "--max-splats", "400", "--threads", "2", "--json"});
    all.insert(all.end(), more.begin(), more.end());
    const ChildResult result = run(all);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    // 20.7 dB when written, opaque 18.3. Other processors round differently.
    EXPECT_GT(nlohmann::json::parse(result.out)["test"]["psnr_db"], 15) << output;
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

TEST_F(TrainGaussians, FlatOnesAreDiscs) {
  make_dataset();
  const ChildResult result =
      gaussians("discs.glb", {"--flat", "--steps", "250", "--max-splats", "400", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_NEAR(json["test"]["psnr_db"].get<double>(), json["trainer_psnr_db"].get<double>(), 0.1);
  // The value when written is 17.6 dB. Other processors round differently.
  EXPECT_GT(json["trainer_psnr_db"], 15);
  const Scene discs = read_scene(folder / "discs.glb");
  EXPECT_EQ(profile_name(splats_of(discs)), "2dgs");
  EXPECT_TRUE(std::get<Gaussians>(splats_of(discs).kernel).flat);
  // They are the first ones of another run of discs, but not of one of Gaussians.
  EXPECT_EQ(gaussians("more.glb", {"--flat", "--init", "discs.glb", "--steps", "20"}).exit_code, 0);
  const ChildResult round = gaussians("round.glb", {"--init", "discs.glb", "--steps", "20"});
  EXPECT_EQ(round.exit_code, 3);
  EXPECT_THAT(round.err, Names("flat Gaussians", "discs.glb"));
  EXPECT_THAT(round.err, testing::HasSubstr("--flat trains"));
  const ChildResult triangles = run({"train", "ball", "-o", "soft.glb", "--method", "triangles",
                                     "--init", "discs.glb", "--steps", "20"});
  EXPECT_EQ(triangles.exit_code, 3);
  EXPECT_THAT(triangles.err, testing::Not(testing::HasSubstr("--flat")));
  EXPECT_THAT(triangles.err, testing::HasSubstr("--init random"));
  EXPECT_THAT(run({"train", "ball", "-o", "x.glb", "--flat"}).err,
              Names("--flat", "--method gaussians"));
}

TEST_F(TrainGaussians, ResumesAfterCtrlCWithTheSameBits) {
  make_dataset();
  const auto options = [](const std::string& number) -> std::vector<std::string> {
    return {"--steps", number, "--max-splats", "300"};
  };
  const auto [cut, steps] = interrupted(
      1000, [&](const std::string& number) { return words("ball.glb", options(number)); });
  ASSERT_EQ(cut.exit_code, 5) << cut.err;
  EXPECT_THAT(cut.err, Names("ball.checkpoint", counted(std::uint64_t(steps)), "--resume"));
  const auto refused = [&](const std::vector<std::string>& changed, const auto&... values) {
    const ChildResult result = gaussians("ball.glb", changed);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_THAT(result.err, Names(values...));
  };
  refused({}, "ball.checkpoint");
  refused({"--resume", "--seed", "3"}, "seed", 3, 0);
  refused({"--resume", "--max-splats", "301"}, "max_splats", 301, 300);
  refused({"--resume", "--scale", "0.5"}, "r_0.png", 16, 32);
  const ChildResult soup =
      run({"train", "ball", "-o", "ball.glb", "--method", "diffsoup", "--resume"});
  EXPECT_EQ(soup.exit_code, 3);
  EXPECT_THAT(soup.err, Names("ball.checkpoint", "--method gaussians"));

  // The method and the constants are those of the checkpoint, the photographs those of the log;
  // other threads, the same bits.
  const ChildResult result = run({"train", "-o", "ball.glb", "--resume", "--threads", "1"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_FALSE(exists("ball.checkpoint"));
  const ChildResult again = run({"train", "-o", "ball.glb", "--resume"});
  EXPECT_EQ(again.exit_code, 3);
  EXPECT_THAT(again.err, Names("ball.checkpoint", "ended"));
  fs::create_directories(folder / "whole");
  ASSERT_EQ(gaussians("whole/ball.glb", options(std::to_string(steps))).exit_code, 0);
  EXPECT_EQ(bytes("ball.glb"), bytes("whole/ball.glb"));
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
  make_dataset(Behind::place);
  write("few.json", R"({"steps": 30, "max_splats": 60, "seed": 5, "degree": 1})");
  const auto print = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all{"train", "ball", "--method", "gaussians", "--print-config"};
    all.insert(all.end(), more.begin(), more.end());
    const ChildResult result = run(all);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return nlohmann::json::parse(result.out);
  };
  EXPECT_EQ(print({})["background"], nlohmann::json({0, 0, 0}));  // no alpha
  make_dataset(Behind::white);
  EXPECT_EQ(print({})["background"], nlohmann::json({1, 1, 1}));
  make_dataset(Behind::place);
  const auto mixed = print({"--config", "few.json", "--max-splats", "40", "--init", "random"});
  EXPECT_EQ(mixed["steps"], 30);
  EXPECT_EQ(mixed["max_splats"], 40);
  EXPECT_EQ(mixed["degree"], 1);
  EXPECT_EQ(mixed["initialisation"], "random");
  EXPECT_EQ(print({"--minutes", "2.5"})["minutes"], 2.5);
  // --steps replaces the minutes of a file, and the program says so.
  write("long.json", R"({"minutes": 90, "steps": 7})");
  EXPECT_EQ(print({"--config", "long.json"})["minutes"], 90);
  EXPECT_EQ(print({"--config", "long.json", "--steps", "20"})["minutes"], 0);
  const ChildResult short_run =
      gaussians("short.glb", {"--config", "long.json", "--steps", "20", "--max-splats", "40"});
  ASSERT_EQ(short_run.exit_code, 0) << short_run.err;
  EXPECT_THAT(short_run.err, Names("--steps", "90 min", "20 steps"));
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
  EXPECT_GT(json["seconds"], 0.95 * 1.8);
  // Soups have minutes, too; with 32 pixels a side, the photographs keep their size.
  const ChildResult soup =
      run({"train", "ball", "-o", "soup.ply", "--minutes", "0.02", "--triangles", "90", "--json"});
  ASSERT_EQ(soup.exit_code, 0) << soup.err;
  const auto made = nlohmann::json::parse(soup.out);
  EXPECT_GT(made["seconds"], 0.95 * 1.2);
  EXPECT_EQ(made["triangles"], 90);
  EXPECT_EQ(made["test"]["scale"], 1);
  EXPECT_THAT(soup.err, Names("--scale 1", "soup.ply"));
  EXPECT_EQ(triangle_count(read_scene(folder / "soup.ply")), 90u);
}

TEST_F(TrainGaussians, ReportsWrongUsageAndInputs) {
  make_dataset();
  const auto expect = [&](const std::vector<std::string>& more, int code, const auto&... values) {
    const ChildResult result = gaussians("b.glb", more);
    EXPECT_EQ(result.exit_code, code) << result.err;
    EXPECT_THAT(result.err, Names(values...));
  };
  // The hints fit the options.
  expect({"--level", "2"}, 2, "--level", "diffsoup", "textures");
  expect({"--preset", "scene"}, 2, "--preset", "diffsoup", "alpha", "--config");
  expect({"--compat"}, 2, "--compat", "diffsoup", "--config");
  expect({"--batch", "2"}, 2, "--batch", "diffsoup", "--steps");
  expect({"--triangles", "100"}, 2, "--triangles", "--max-splats");
  expect({"--device", "cuda"}, 2, "--device cuda", "CPU");
  expect({"--export-diffsoup", "web"}, 2, "--export-diffsoup", "page.html");
  expect({"--steps", "5", "--minutes", "1"}, 2, "--steps", "--minutes");
  expect({"--max-splats", "0"}, 2, "max_splats", 0, 1);
  expect({"--max-splats", "-3"}, 2, "max_splats", -3);
  expect({"--minutes", "-1"}, 2, "--minutes", -1, 0, "--steps");
  expect({"--minutes", "0"}, 2, "--minutes", 0, "--steps");
  expect({"--minutes", "nan"}, 2, "--minutes", "finite number");
  expect({"--minutes", "1e6"}, 2, "minutes", 1000000, 100000);
  write("past.json", R"({"minutes": -0.5})");
  expect({"--config", "past.json"}, 3, "past.json", "minutes", "-0.5", "fixed number of steps");
  expect({"--max-memory", "16MiB"}, 2, "--max-memory");
  expect({"--init", "points"}, 3, "points");
  expect({"--init", "pionts"}, 3, "pionts", "points");
  write("bad.json", R"({"max_splat": 3})");
  expect({"--config", "bad.json"}, 3, "bad.json", "max_splat", "max_splats");
  expect({"--config", "nofile.json"}, 3, "nofile.json", "no such file");
  write("soup.json", run({"train", "ball", "--print-config"}).out);
  expect({"--config", "soup.json"}, 3, "soup.json", "--method diffsoup", "--list-config");
  write("mesh.json", R"({"initialisation": "mesh"})");
  expect({"--config", "mesh.json"}, 2, "--init", "FILE");
  expect({"--resume"}, 3, "b.checkpoint");
  const ChildResult method = run({"train", "ball", "-o", "b.glb", "--method", "gausians"});
  EXPECT_EQ(method.exit_code, 2);
  EXPECT_THAT(method.err, Names("gausians", "gaussians"));
  const ChildResult soup = train("b.glb", {"--max-splats", "100"});
  EXPECT_EQ(soup.exit_code, 2);
  EXPECT_THAT(soup.err, Names("--max-splats", "gaussians", "--triangles"));
  EXPECT_EQ(run({"train", "ball", "-o", "b.jpg"}).exit_code, 2);
  EXPECT_EQ(run({"train", "-o", "b.glb"}).exit_code, 2);  // no dataset, no run to resume
  const ChildResult discs = run({"train", "ball", "--method", "2dgs", "--print-config"});
  EXPECT_EQ(nlohmann::json::parse(discs.out)["flat"], true);
  write("splats.json", run({"train", "ball", "--method", "gaussians", "--print-config"}).out);
  const ChildResult config = train("b.glb", {"--config", "splats.json"}, "40", First::as_given);
  EXPECT_EQ(config.exit_code, 3);
  EXPECT_THAT(config.err, Names("splats.json", "--method gaussians"));
  const ChildResult upper = run({"train", "ball", "-o", "b.glb", "--method", "GAUSSIANS"});
  EXPECT_EQ(upper.exit_code, 2);
  EXPECT_THAT(upper.err, Names("GAUSSIANS", "did you mean gaussians"));
  EXPECT_FALSE(exists("b.glb"));
}

TEST_F(TrainGaussians, AreAStartForASoup) {
  make_dataset();
  ASSERT_EQ(gaussians("a.glb", {"--steps", "3", "--max-splats", "200"}).exit_code, 0);
  Scene far = read_scene(folder / "a.glb");
  far.layers[0].world_from_layer[3] += glm::dvec4(1000, 1000, 1000, 0);
  ASSERT_THAT(tureen::write_scene(far, folder / "far.glb"), testing::IsEmpty());
  for (const char* start : {"a.glb", "far.glb"}) {
    const ChildResult result = train("b.glb", {"--init", start, "--json"}, "40", First::as_given);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(nlohmann::json::parse(result.out)["visible_at_start"], start[0] == 'a') << start;
  }
}

TEST_F(TrainGaussians, ResumesWithAMemoryLimitAndAFileWithoutBackground) {
  make_dataset(
      Behind::place);  // without alpha the background is black, which the file does not say
  std::vector<std::string> more{"--config", "few.json", "--max-memory", "80MiB"};
  const ChildResult cut = interrupted(200, [&](const std::string& number) {
                            write("few.json", R"({"steps": )" + number + R"(, "seed": 5})");
                            return words("ball.glb", more);
                          }).result;
  ASSERT_EQ(cut.exit_code, 5) << cut.err;
  EXPECT_THAT(cut.err, Names("--max-memory"));
  const auto resumed = [&](std::vector<std::string> changed) {
    changed.emplace_back("--resume");
    return gaussians("ball.glb", changed);
  };
  // Other constants are refused as without these options.
  const ChildResult seed =
      resumed({"--config", "few.json", "--max-memory", "80MiB", "--seed", "6"});
  EXPECT_EQ(seed.exit_code, 2);
  EXPECT_THAT(seed.err, Names("seed", 6, 5));
  const ChildResult fewer =
      resumed({"--config", "few.json", "--max-memory", "80MiB", "--max-splats", "100"});
  EXPECT_EQ(fewer.exit_code, 2);
  EXPECT_THAT(fewer.err, Names("max_splats", 100));
  const ChildResult result = resumed({"--config", "few.json", "--max-memory", "80MiB"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

TEST_F(TrainGaussians, NeedsNeitherTestViewsNorPointsNorTwoPhotographs) {
  write_split("train", 1, 0, Behind::place);
  write("ball/transforms.json", bytes("ball/transforms_train.json"));
  fs::remove(folder / "ball/transforms_train.json");
  for (const std::string method : {"gaussians", "diffsoup"}) {
    SCOPED_TRACE(method);
    const ChildResult result =
        run({"train", "ball", "-o", method + ".glb", "--method", method, "--steps", "30",
             "--preview-every", "15", "--json", "--threads", "2", "--device", "cpu"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.err, Names("no test views", "1 training view and 0 test views"));
    EXPECT_THAT(result.err, Not(testing::HasSubstr("PSNR")));
    const auto json = nlohmann::json::parse(result.out);
    EXPECT_EQ(json["test"], nlohmann::json({{"views", 0}}));
    EXPECT_FALSE(json.contains("trainer_psnr_db"));
    EXPECT_EQ(read_png(method + ".previews/step_00000015.png").width, size);
    EXPECT_FALSE(trainer::read_training_log(folder / (method + ".jsonl")).back().test_psnr_db);
    EXPECT_EQ(run({"info", method + ".glb"}).exit_code, 0);
    EXPECT_EQ(run({"report", method + ".jsonl", "-o", method + ".html"}).exit_code, 0);
  }
}

TEST_F(TrainGaussians, AnnounceWhatTheyReplaceAfterAllChecks) {
  make_dataset();
  ASSERT_EQ(gaussians("ball.glb", {"--steps", "3", "--max-splats", "50"}).exit_code, 0);
  const auto replaces = testing::HasSubstr("training replaces");
  for (const std::vector<std::string>& wrong : std::vector<std::vector<std::string>>{
           {"--init", "points"}, {"--scale", "0.2"}, {"--config", "none.json"}}) {
    const ChildResult result = gaussians("ball.glb", wrong);
    EXPECT_EQ(result.exit_code, 3) << result.err;
    EXPECT_THAT(result.err, Not(replaces));
  }
  const ChildResult again = gaussians("ball.glb", {"--steps", "1", "--max-splats", "50"});
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_THAT(again.err, AllOf(replaces, Names("1 step,")));
}

}  // namespace train_gaussians_program_test
}  // namespace tureen
