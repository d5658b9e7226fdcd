// The command that trains a scene from photographs.
#include "viewer/training_command.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

namespace tureen::viewer {
namespace training_command_test {

namespace fs = std::filesystem;

TEST(TrainingCommand, NamesASceneBesideTheDatasetThatDoesNotExist) {
  const fs::path folder = fs::path(testing::TempDir()) / "training_command";
  fs::remove_all(folder);
  fs::create_directories(folder / "fox");
  EXPECT_EQ(new_trained_scene(folder / "fox"), folder / "fox.glb");
  std::ofstream(folder / "fox.glb") << "x";
  std::ofstream(folder / "fox-2.checkpoint") << "x";
  EXPECT_EQ(new_trained_scene(folder / "fox/"), folder / "fox-3.glb");
}

TEST(TrainingCommand, HasTheMethodAndItsOptions) {
  const TrainingMethodInfo* gaussians = training_methods()[1];
  const TrainingChoice choice{
      .method = gaussians,
      .steps = "500",
      .values = {{"flat", "on"}, {"max-splats", "9"}, {"minutes", ""}, {"triangles", "7"}}};
  // Those of other methods, which were typed before the choice of this one, are left out.
  EXPECT_THAT(training_arguments("/fox", "/a.glb", TrainingStart::new_run, choice),
              testing::ElementsAre("train", "/fox", "-o", "/a.glb", "--watch", "--method",
                                   "gaussians", "--steps", "500", "--max-splats", "9", "--flat"));
}

TEST(TrainingCommand, HasTheSizeOfThePhotographs) {
  EXPECT_THAT(training_arguments("/fox", "/a.glb", TrainingStart::new_run, {.scale = "0.25"}),
              testing::ElementsAre("train", "/fox", "-o", "/a.glb", "--watch", "--scale", "0.25"));
}

TEST(TrainingCommand, HasAForecast) {
  FullPhotographs full;
  Camera camera;
  camera.width = 1000;
  camera.height = 500;
  full.cameras.push_back(camera);
  const TrainingMethodInfo* gaussians = training_methods()[1];
  ASSERT_EQ(gaussians->cost_of_pixel, 1);
  const double second_a_step = 1 / 550e3;  // of 500,000 pixels, and splats that cost 50,000
  const auto text = [&](const std::string& minutes, const std::string& steps,
                        const std::string& scale) {
    return forecast_text(
        {.method = gaussians, .steps = steps, .scale = scale, .values = {{"minutes", minutes}}},
        full, second_a_step);
  };
  using testing::HasSubstr;
  EXPECT_THAT(text("15", "", "1"),
              testing::AllOf(HasSubstr("900 steps"), HasSubstr("1000 \u00d7 500")));
  // Without a size, the time chooses it.
  EXPECT_THAT(text("15", "", ""), testing::Not(HasSubstr("1000 \u00d7 500")));
  EXPECT_THAT(text("", "120", "1"), HasSubstr("2 min"));
  EXPECT_THAT(text("", "120", "0.5"), HasSubstr("500 \u00d7 250"));
  EXPECT_EQ(text("x", "", ""), text("", "", ""));
  EXPECT_EQ(text("0", "120", "1"), text("", "120", "1"));
}

TEST(TrainingCommand, ChecksTheFolderForCameras) {
  const fs::path folder = fs::path(testing::TempDir()) / "cameras_typed";
  fs::remove_all(folder);
  fs::create_directories(folder / "empty");
  std::ofstream(folder / "file") << "x";
  EXPECT_EQ(dataset_defect(folder / "new"), "");
  EXPECT_EQ(dataset_defect(folder / "empty"), "");
  EXPECT_THAT(dataset_defect(folder), testing::HasSubstr("is not empty"));
  EXPECT_THAT(dataset_defect(folder / "file"), testing::HasSubstr("a file"));
}

TEST(TrainingCommand, ContinuesFromACheckpoint) {
  const fs::path folder = fs::path(testing::TempDir()) / "training_continued";
  fs::remove_all(folder);
  fs::create_directories(folder / "fox");
  const fs::path dataset = folder / "fox", scene = folder / "scene.glb";
  EXPECT_THAT(training_arguments(dataset, scene),
              testing::ElementsAre("train", dataset.string(), "-o", scene.string(), "--watch"));
  EXPECT_EQ(command_that_continues(dataset, scene), "");
  std::ofstream(folder / "scene.checkpoint") << "x";
  EXPECT_EQ(command_that_continues(dataset, scene),
            "tureen train " + dataset.string() + " -o " + scene.string() + " --watch --resume");
}

TEST(TrainingCommand, OfATypedSceneChecksWhatTheTrainingWouldRefuse) {
  const fs::path folder = fs::path(testing::TempDir()) / "training_typed";
  fs::remove_all(folder);
  fs::create_directories(folder / "folder.glb");
  EXPECT_FALSE(check_typed_scene("").is_possible);
  EXPECT_FALSE(check_typed_scene(folder / "folder.glb").is_possible);
  EXPECT_FALSE(check_typed_scene(folder / "scene.ply").is_possible);
  const TypedScene missing = check_typed_scene(folder / "none" / "scene.glb");
  EXPECT_FALSE(missing.is_possible);
  EXPECT_THAT(missing.remark, testing::HasSubstr((folder / "none").string()));
  const TypedScene good = check_typed_scene(folder / "scene.glb");
  EXPECT_TRUE(good.is_possible);
  EXPECT_EQ(good.remark, "");
  std::ofstream(folder / "scene.glb") << "x";
  EXPECT_TRUE(check_typed_scene(folder / "scene.glb").is_possible);
  EXPECT_NE(check_typed_scene(folder / "scene.glb").remark, "");
  std::ofstream(folder / "scene.checkpoint") << "x";
  EXPECT_TRUE(check_typed_scene(folder / "scene.glb").is_unfinished);
}

TEST(TrainingCommand, TheNoteOfItsEndHasTheReasonWithoutACheckpoint) {
  const fs::path folder = fs::path(testing::TempDir()) / "training_ended";
  fs::remove_all(folder);
  fs::create_directories(folder / "fox");
  EndedTraining training{.dataset = folder / "fox", .scene = folder / "scene.glb"};
  EXPECT_EQ(note_of(training), "The training of scene.glb has ended.");
  training.failure = "no space";
  EXPECT_EQ(note_of(training), "");
  training.is_stopped = true;
  EXPECT_EQ(note_of(training),
            "The training of scene.glb was stopped: no space. It has no checkpoint.");
  training.wrote_scene = true;  // stopped while it measured the scene
  EXPECT_EQ(note_of(training), "The training of scene.glb has ended.");
  std::ofstream(folder / "scene.checkpoint") << "x";
  const std::string further =
      " To continue: " + command_that_continues(training.dataset, training.scene);
  EXPECT_EQ(note_of(training), "The training of scene.glb was stopped: no space." + further);
  training.wrote_checkpoint = true;
  EXPECT_EQ(note_of(training), "The training of scene.glb was stopped." + further);
}

}  // namespace training_command_test
}  // namespace tureen::viewer
