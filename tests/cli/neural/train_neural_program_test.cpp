// Program tests of `tureen train --method neural` and of --max-bytes, on photographs of a coloured
// ball, 32 pixels a side.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "formats/scene_file.hpp"
#include "tests/cli/train_fixture.hpp"
#include "tests/support/errors.hpp"

namespace tureen {
namespace train_neural_program_test {

using test::ChildResult;
using test::Names;
namespace fs = std::filesystem;

class TrainNeural : public test::Train {
 protected:
  ChildResult neural(const std::string& output, const std::vector<std::string>& more = {},
                     const std::string& method = "neural") const {
    std::vector<std::string> all{"train",    "ball", "-o",        output,
                                 "--method", method, "--threads", "2"};
    all.insert(all.end(), more.begin(), more.end());
    return run(all);
  }
  Splats splats_of(const std::string& name) const {
    return std::get<Splats>(only_layer(read_scene(folder / name)).primitives);
  }
};

TEST_F(TrainNeural, TrainsASceneThatTheAuthorsFilesHold) {
  make_dataset();
  const ChildResult result = neural("ball.glb", {"--steps", "150", "--max-splats", "60", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["non_finite"], 0);
  EXPECT_LE(json["splats"], 60);
  // 1 dB less than as many Gaussians after 250 steps (TrainGaussians).
  EXPECT_GT(json["trainer_psnr_db"], 16);
  // The bound allows for two renderers and for rounding to bytes.
  EXPECT_NEAR(json["test"]["psnr_db"].get<double>(), json["trainer_psnr_db"].get<double>(), 0.1);
  const Splats trained = splats_of("ball.glb");
  ASSERT_TRUE(std::holds_alternative<NeuralDensities>(trained.kernel));
  EXPECT_EQ(profile_name(trained), "splatnet");

  ASSERT_EQ(run({"convert", "ball.glb", "ball.ply"}).exit_code, 0);
  const Splats again = splats_of("ball.ply");
  ASSERT_TRUE(std::holds_alternative<NeuralDensities>(again.kernel));
  EXPECT_EQ(count(again), count(trained));
}

TEST_F(TrainNeural, ResumesAfterCtrlCWithTheSameBits) {
  make_dataset();
  const auto words = [](const std::string& output, const std::string& steps) {
    return std::vector<std::string>{"train",    "ball",   "-o",           output,
                                    "--method", "neural", "--max-splats", "40",
                                    "--steps",  steps,    "--threads",    "2"};
  };
  const auto [cut, steps] =
      interrupted(600, [&](const std::string& number) { return words("ball.glb", number); });
  ASSERT_EQ(cut.exit_code, 5) << cut.err;
  const ChildResult result =
      run({"train", "ball", "-o", "ball.glb", "--method", "neural", "--resume", "--threads", "1"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  fs::create_directories(folder / "whole");
  ASSERT_EQ(run(words("whole/ball.glb", std::to_string(steps))).exit_code, 0);
  EXPECT_EQ(bytes("ball.glb"), bytes("whole/ball.glb"));
}

TEST_F(TrainNeural, BeginsWithPointsMeshesGaussiansAndDensities) {
  make_dataset();
  const auto number = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all{"--steps", "2", "--json"};
    all.insert(all.end(), more.begin(), more.end());
    const ChildResult result = neural("b.glb", all);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return nlohmann::json::parse(result.out)["splats"].get<int>();
  };
  EXPECT_EQ(number({"--init", "random", "--max-splats", "30"}), 30);
  write_scene();
  EXPECT_EQ(number({"--init", "scene.off", "--max-splats", "50"}), 50);
  ASSERT_EQ(neural("a.glb", {"--steps", "60", "--max-splats", "80"}, "gaussians").exit_code, 0);
  const auto gaussians = int(count(splats_of("a.glb")));
  EXPECT_EQ(number({"--init", "a.glb"}), gaussians);
  fs::copy_file(folder / "b.glb", folder / "c.glb");
  EXPECT_EQ(number({"--init", "c.glb"}), gaussians);
  // Discs have no third semi-axis.
  ASSERT_EQ(
      neural("d.glb", {"--steps", "5", "--max-splats", "20", "--flat"}, "gaussians").exit_code, 0);
  const ChildResult discs = neural("b.glb", {"--init", "d.glb"});
  EXPECT_NE(discs.exit_code, 0);
  EXPECT_THAT(discs.err, Names("flat Gaussians", "neural densities"));
}

TEST_F(TrainNeural, ChoosesNumberAndDegreeByBytes) {
  make_dataset();
  const auto print = [&](const std::string& method, const std::string& bytes) {
    const ChildResult result =
        run({"train", "ball", "--method", method, "--max-bytes", bytes, "--print-config"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return nlohmann::json::parse(result.out);
  };
  // Values of a splat before its harmonics.
  const std::pair<const char*, int> methods[] = {
      {"gaussians", 11}, {"triangles", 11}, {"neural", 51}};
  for (const auto& [method, values] : methods) {
    int last_degree = 0;
    for (const int bytes : {1000, 10'000, 100'000, 1'000'000, 10'000'000}) {
      const auto constants = print(method, std::to_string(bytes));
      const int degree = constants["degree"], each = 4 * (values + 3 * (degree + 1) * (degree + 1));
      EXPECT_EQ(constants["max_splats"], bytes / each) << method;
      EXPECT_GE(degree, last_degree);
      last_degree = degree;
    }
    EXPECT_EQ(last_degree, 2) << method;
  }
  const ChildResult result = neural("b.glb", {"--steps", "2", "--max-bytes", "2200"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, Names("--max-bytes", 2200));
  EXPECT_LE(count(splats_of("b.glb")), 10u);
  const auto refused = [&](const std::vector<std::string>& more, const auto&... values) {
    const ChildResult run_of = neural("b.glb", more);
    EXPECT_EQ(run_of.exit_code, 2) << run_of.err;
    EXPECT_THAT(run_of.err, Names(values...));
  };
  refused({"--max-bytes", "100"}, "--max-bytes", 100, 216);
  refused({"--max-bytes", "5000", "--max-splats", "5"}, "--max-bytes", "--max-splats");
}

}  // namespace train_neural_program_test
}  // namespace tureen
