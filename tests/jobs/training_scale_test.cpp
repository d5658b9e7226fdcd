#include "jobs/training/training_scale.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "jobs/training/photograph_size.hpp"
#include "jobs/training/run_input.hpp"

namespace tureen {
namespace training_scale_test {

/// Eight cameras on a circle around the origin, which look at it.
Dataset ring(double radius) {
  Dataset dataset;
  for (int i = 0; i < 8; ++i) {
    const glm::dvec3 eye = radius * glm::dvec3(std::cos(i), std::sin(i), 0.5);
    Photograph view;
    view.camera = look_at(eye, glm::dvec3(0), {0, 0, 1}, 0.7, 32, 32);
    dataset.train.push_back(view);
  }
  dataset.points.push_back({{0.5 * radius, 0, 0}, {}});
  return dataset;
}

TEST(TrainingScale, LeavesUsualScenesAndScalesOthersToThem) {
  for (const double radius : {1.5, 4.0, 80.0}) EXPECT_EQ(training_scale(ring(radius)), 1);
  for (const double radius : {0.01, 0.08, 4000.0}) {
    Dataset dataset = ring(radius);
    const glm::dvec3 eye = dataset.train[3].camera.eye();
    const double scale = training_scale(dataset);
    scale_dataset(dataset, scale);
    EXPECT_EQ(training_scale(dataset), 1);
    EXPECT_LT(glm::distance(dataset.train[3].camera.eye(), scale * eye), 1e-9);
    EXPECT_EQ(dataset.points[0].position.x, 0.5 * radius * scale);
    Scene scene;
    scene.layers.emplace_back();
    scene.cameras.push_back(dataset.train[3].camera);
    const Scene back = scaled_scene(scene, 1 / scale);
    EXPECT_EQ(back.layers[0].world_from_layer[1][1], 1 / scale);
    EXPECT_LT(glm::distance(back.cameras[0].eye(), eye), 1e-9 * radius);
  }
}

TEST(PhotographSize, IsTheLargestThatTheTimeAllows) {
  TimeForSteps time{.pixels = 4e6, .seconds_per_pixel = 1e-7, .steps = 1000};
  for (const double scale : {1.0, 0.5, 0.25, 0.125}) {
    time.seconds = 1000 * time.of_step(scale);
    EXPECT_EQ(scale_for(time), scale);
    time.seconds *= 0.99;
    EXPECT_EQ(scale_for(time), std::max(scale / 2, 0.125));
  }
  EXPECT_GT(time.of_step(0.5), time.of_step(1) / 4);  // a part does not depend on the size
  time.seconds = 1;
  time.pixels = 600'000;  // 37,500 at a quarter
  EXPECT_EQ(scale_for(time), 0.25);
  time.pixels = 20'000;
  EXPECT_EQ(scale_for(time), 1);
}

TEST(PhotographSize, IsInTheNote) {
  FullPhotographs full;
  full.cameras.resize(2);
  for (Camera& camera : full.cameras) camera.width = camera.height = 1000;
  const TrainingMethodInfo& method = *training_methods()[1];
  const double pixel = 60.0 / (method.least_steps * 500'000);  // full size: half of the steps
  const PhotographSize size = photographs_for(1, full, method, pixel);
  EXPECT_EQ(size.scale, 0.5);
  EXPECT_EQ(std::get<double>(size.note.value), 0.5);
  EXPECT_THAT(size.note.text, testing::HasSubstr("--scale 0.5"));
  full.of_an_object = true;
  EXPECT_EQ(photographs_for(1, full, method, pixel).scale, 1);
  EXPECT_GT(measured_seconds_per_pixel(1), 0);
}

TEST(PhotographSize, TooFewStepsAreNoted) {
  FullPhotographs full;
  full.cameras.resize(40);
  const TrainingMethodInfo& method = *training_methods()[1];
  const int least = method.least_steps / 4;
  ASSERT_GT(least, 200);
  EXPECT_FALSE(too_few_steps(least, full, method));
  const auto warning = too_few_steps(least - 1, full, method);
  ASSERT_TRUE(warning);
  EXPECT_EQ(std::get<double>(warning->value), least);
  EXPECT_THAT(warning->text, testing::HasSubstr("40 photographs"));
  EXPECT_THAT(warning->text, testing::HasSubstr("more minutes"));
  full.of_an_object = true;  // a quarter suffices
  EXPECT_FALSE(too_few_steps(least / 4, full, method));
  full.cameras.resize(std::size_t(least));  // each once
  EXPECT_TRUE(too_few_steps(least - 1, full, method));
  EXPECT_FALSE(too_few_steps(least, full, method));
}

TEST(RunInput, ComesBackFromTheLog) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / "tureen_run_input";
  std::filesystem::create_directories(folder);
  const std::filesystem::path log = folder / "a.jsonl";
  std::filesystem::remove(log);
  EXPECT_FALSE(input_of_log(log));
  const auto write = [&](const std::string& plan) { std::ofstream(log) << plan << "\n{\n"; };
  RunInput input{"photos/ball", {.scale = 0.25, .images_folder = 2, .test_every = 5}};
  input.options.alpha = AlphaMeaning::mask;
  input.options.is_strict = true;
  write(R"({"step":0,"plan":{"input":)" + nlohmann::json::parse(to_json(input, log)).dump() + "}}");
  const auto read = input_of_log(log);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->dataset, std::filesystem::absolute("photos/ball"));
  EXPECT_EQ(read->options.scale, 0.25);
  EXPECT_EQ(read->options.images_folder, 2);
  EXPECT_EQ(read->options.test_every, 5);
  EXPECT_EQ(read->options.alpha, AlphaMeaning::mask);
  EXPECT_TRUE(read->options.is_strict);
  write(R"({"step":0,"plan":{}})");  // of an earlier version
  EXPECT_FALSE(input_of_log(log));
  for (const char* bad : {R"("scale":0)", R"("scale":2)", R"("images":0)", R"("test_every":1)",
                          R"("alpha":"x")", R"("dataset":3)"}) {
    nlohmann::json damaged = nlohmann::json::parse(to_json(input, log));
    damaged.merge_patch(nlohmann::json::parse("{" + std::string(bad) + "}"));
    write(R"({"step":0,"plan":{"input":)" + damaged.dump() + "}}");
    EXPECT_THROW(input_of_log(log), InputError) << bad;
  }
  std::filesystem::remove_all(folder);
}

}  // namespace training_scale_test
}  // namespace tureen
