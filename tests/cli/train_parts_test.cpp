// Parts of `tureen train` that need no training.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <utility>

#include "base/error.hpp"
#include "cli/progress.hpp"
#include "jobs/training/diffsoup_options.hpp"
#include "jobs/training/training_run.hpp"
#include "scene/scene.hpp"
#include "tests/support/errors.hpp"
#include "trainer/diffsoup/config_fields.hpp"

namespace tureen::cli {
namespace train_parts_test {

namespace fs = std::filesystem;
using trainer::Config;
using trainer::Preset;

TEST(TrainingFiles, LieBesideTheScene) {
  const trainer::TrainingFiles files = trainer::training_files("runs/a.b.glb");
  EXPECT_EQ(files.scene, "runs/a.b.glb");
  EXPECT_EQ(files.checkpoint, "runs/a.b.checkpoint");
  EXPECT_EQ(files.log, "runs/a.b.jsonl");
  EXPECT_EQ(files.previews, "runs/a.b.previews");
  EXPECT_THROW(trainer::training_files("a"), UsageError);
  EXPECT_THROW(trainer::training_files("a.gltf"), UsageError);
}

TEST(TrainingRun, TriesItsFilesAndLeavesNothing) {
  const fs::path folder = fs::path(testing::TempDir()) / "tureen_training_files";
  fs::remove_all(folder);
  fs::create_directories(folder / "full");
  std::ofstream(folder / "full" / "letter.txt") << "dear";
  TrainingJob job;
  job.output = folder / "a.glb";
  const auto make = [&] { const TrainingRun run(job); };
  EXPECT_NO_THROW(make());
  job.log = folder / "full";
  EXPECT_THROW(make(), OutputError);
  job.log = folder / "full" / "letter.txt";
  EXPECT_THROW(make(), UsageError);
  job.log = folder / "a.lock";
  EXPECT_THROW(make(), UsageError);
  job = {};
  job.output = folder / "none" / "a.glb";
  EXPECT_THROW(make(), OutputError);
  std::size_t entries = 0;
  for ([[maybe_unused]] const auto& entry : fs::recursive_directory_iterator(folder)) ++entries;
  EXPECT_EQ(entries, 2u);
  fs::remove_all(folder);
}

TEST(TrainingMethods, HaveOptionsOfTheirOwnThatOthersRefuse) {
  for (const auto& [option, methods] : all_method_options())
    for (const TrainingMethodInfo* method : training_methods()) {
      TrainingOptions options;
      options.method = method;
      OptionValue& value = options.own[option->name];
      switch (option->type) {
        case MethodOption::Type::flag:
          value.flag = true;
          break;
        case MethodOption::Type::whole:
          value.whole = 100;
          break;
        case MethodOption::Type::number:
          value.number = 1;
          break;
        case MethodOption::Type::word:
          value.text = option->words.front();
          break;
        case MethodOption::Type::path:
          value.text = "folder";
          break;
      }
      const bool has = std::ranges::find(methods, method) != methods.end();
      if (has || !option->everywhere.empty())
        EXPECT_NO_THROW(make_training_method(options)) << method->name << " --" << option->name;
      else
        EXPECT_THROW(make_training_method(options), UsageError)
            << method->name << " --" << option->name;
    }
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
