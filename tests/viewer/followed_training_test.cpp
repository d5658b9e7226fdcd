#include "viewer/files/followed_training.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "base/error.hpp"
#include "tests/support/errors.hpp"

namespace tureen::viewer {
namespace followed_training_test {

namespace fs = std::filesystem;
using trainer::RunCommand;

class Followed : public testing::Test {
 protected:
  Followed()
      : folder(fs::path(testing::TempDir()) /
               (std::string("tureen_followed_") +
                testing::UnitTest::GetInstance()->current_test_info()->name())) {
    fs::remove_all(folder);
    fs::create_directories(folder);
  }
  ~Followed() override { fs::remove_all(folder); }

  fs::path folder, log = folder / "run.jsonl", control = folder / "run.control";
};

TEST_F(Followed, TellsWhatHasChanged) {
  FollowedTraining training(log);
  EXPECT_FALSE(training.update());
  EXPECT_EQ(training.command(), std::nullopt);
  {
    const trainer::RunControl run(control);
    trainer::TrainingLog written = trainer::TrainingLog::create(log);
    EXPECT_TRUE(training.update());
    EXPECT_EQ(training.command(), RunCommand::run);
    EXPECT_FALSE(training.update());
    written.append({.step = 50, .steps = 100});
    EXPECT_TRUE(training.update());
    EXPECT_EQ(training.records().size(), 1u);
    training.send(RunCommand::pause);
    EXPECT_EQ(training.command(), RunCommand::pause);
    EXPECT_EQ(trainer::read_command(control), RunCommand::pause);
  }
  EXPECT_TRUE(training.update());
  EXPECT_EQ(training.command(), std::nullopt);
  EXPECT_THROW(training.send(RunCommand::pause), UsageError);
}

TEST_F(Followed, NamesABrokenLineAndGoesOnAfterIt) {
  FollowedTraining training(log);
  trainer::TrainingLog::create(log).append({.step = 50});
  std::ofstream(log, std::ios::app) << "hello\n";
  EXPECT_TRUE(training.update());
  EXPECT_THAT(training.problem(), test::Names("run.jsonl", 2));
  EXPECT_EQ(training.records().size(), 1u);
  EXPECT_FALSE(training.update());
  EXPECT_FALSE(training.problem().empty());
  trainer::TrainingLog::create(log).append({.step = 60});
  EXPECT_TRUE(training.update());
  EXPECT_TRUE(training.problem().empty());
}

TEST_F(Followed, FailsToWriteAFolder) {
  fs::create_directories(control);
  FollowedTraining training(log);
  training.update();
  EXPECT_THROW(training.send(RunCommand::finish), OutputError);
  EXPECT_EQ(training.command(), std::nullopt);
}

}  // namespace followed_training_test
}  // namespace tureen::viewer
