// Parts of `tureen train` that need no training.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <utility>

#include "base/error.hpp"
#include "cli/files/train_files.hpp"
#include "cli/progress.hpp"
#include "jobs/training/diffsoup_options.hpp"
#include "jobs/training/training_method.hpp"
#include "scene/scene.hpp"
#include "tests/support/errors.hpp"
#include "trainer/diffsoup/config_fields.hpp"

namespace tureen::cli {
namespace train_parts_test {

namespace fs = std::filesystem;
using trainer::Config;
using trainer::Preset;

TEST(TrainingFiles, LieBesideTheSoup) {
  const TrainingFiles files = training_files("runs/a.b.glb");
  EXPECT_EQ(files.scene, "runs/a.b.glb");
  EXPECT_EQ(files.checkpoint, "runs/a.b.checkpoint");
  EXPECT_EQ(files.log, "runs/a.b.jsonl");
  EXPECT_EQ(files.previews, "runs/a.b.previews");
  EXPECT_TRUE(files.diffsoup_export.empty());
  EXPECT_THROW(training_files("a"), UsageError);
  EXPECT_THROW(training_files("a.gltf"), UsageError);
}

TEST(TrainingFiles, AreTriedAndLeaveNothing) {
  const fs::path folder = fs::path(testing::TempDir()) / "tureen_training_files";
  fs::remove_all(folder);
  fs::create_directories(folder / "full");
  std::ofstream(folder / "full" / "letter.txt") << "dear";
  TrainingFiles files = training_files(folder / "a.glb");
  EXPECT_NO_THROW(check_writable(files));
  files.diffsoup_export = folder / "new";
  EXPECT_NO_THROW(check_writable(files));
  files.diffsoup_export = folder / "none" / "new";
  EXPECT_THROW(check_writable(files), OutputError);
  files.diffsoup_export = folder / "full";
  EXPECT_THROW(check_writable(files), UsageError);
  files = training_files(folder / "a.glb");
  files.log = folder / "full";
  EXPECT_THROW(check_writable(files), OutputError);
  EXPECT_THROW(check_writable(training_files(folder / "none" / "a.glb")), OutputError);
  std::size_t entries = 0;
  for ([[maybe_unused]] const auto& entry : fs::recursive_directory_iterator(folder)) ++entries;
  EXPECT_EQ(entries, 2u);
  fs::remove_all(folder);
}

TEST(SoupTraining, BeginsOnAllScenesButNeuralDensities) {
  const TrainingOptions options;
  const std::unique_ptr<TrainingMethod> method = make_training_method(options);
  const auto unsuitable = [&](SplatKernel kernel) {
    return method->unsuitable(scene_of(Splats{.kernel = std::move(kernel)}));
  };
  EXPECT_FALSE(unsuitable(Gaussians{}));
  EXPECT_FALSE(unsuitable(TriangleWindows{}));
  EXPECT_FALSE(method->unsuitable(scene_of(TriangleSoup{})));
  const auto reason = unsuitable(NeuralDensities{});
  ASSERT_TRUE(reason);
  EXPECT_THAT(reason->what, testing::HasSubstr("triangles or Gaussians"));
  EXPECT_THAT(reason->instead, testing::HasSubstr("--init random"));
}

TEST(ConfigOptions, KeepTheProportionOfTrianglesToBeginWith) {
  const Config base = trainer::published(Preset::object);
  TrainingOptions options;
  options.own["triangles"].whole = 3000;
  const Config config = with_options(base, options);
  EXPECT_EQ(config.triangles, 3000);
  EXPECT_EQ(config.initial_triangles, base.initial_triangles / 5);
  options.own["triangles"].whole = 0;
  EXPECT_THROW(with_options(base, options), UsageError);
  options.own["triangles"].whole = 1;
  EXPECT_GE(with_options(base, options).initial_triangles, 1);
}

TEST(ConfigOptions, AreRefusedByTheNumberThatWasTyped) {
  const auto refusal = [](const std::string& option, std::int64_t value) {
    TrainingOptions options;
    (option == "steps" ? options.steps : options.own[option].whole) = value;
    return test::error_of<UsageError>([&] { with_options(Config{}, options); });
  };
  using test::Names;
  EXPECT_THAT(refusal("triangles", 99'999'999'999), Names("triangles", "99999999999", 4000000));
  EXPECT_THAT(refusal("steps", -99'999'999'999), Names("steps", "-99999999999", 10000000));
  EXPECT_THAT(refusal("batch", 1LL << 40), Names("batch", "1099511627776"));
  EXPECT_THAT(refusal("level", 1LL << 40), Names("max_level", "1099511627776"));
}

TEST(ConfigOptions, LowerWhatWouldBeAboveTheLevel) {
  TrainingOptions options;
  options.own["level"].whole = 1;
  Config base = trainer::preset(Preset::object);
  base.coarse_level = 2;
  const Config config = with_options(base, options);
  EXPECT_EQ(config.max_level, 1);
  EXPECT_EQ(config.min_level, 1);
  EXPECT_EQ(config.coarse_level, 1);
  options.own["level"].whole = 6;
  EXPECT_EQ(with_options(base, options).min_level, base.min_level);
}

TEST(ConfigOptions, ChangeNothingThatIsNotGiven) {
  for (const Preset kind : {Preset::object, Preset::scene}) {
    const Config base = trainer::published(kind), same = with_options(base, {});
    for (const trainer::ConfigField& field : trainer::config_fields())
      EXPECT_EQ(value_text(same, field), value_text(base, field)) << field.name;
  }
}

TEST(ConfigOptions, TellTheWordsOfInitFromAFile) {
  TrainingOptions options;
  EXPECT_EQ(options.mesh(), "");
  options.begin = "random";
  EXPECT_EQ(options.mesh(), "");
  options.begin = "./random";
  EXPECT_EQ(options.mesh(), "./random");
  EXPECT_EQ(with_options(Config{}, options).initialisation, trainer::Initialisation::mesh);
}

}  // namespace train_parts_test
}  // namespace tureen::cli
