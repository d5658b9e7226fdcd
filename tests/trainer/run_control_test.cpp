#include "trainer/common/run_control.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <string>

#include "base/error.hpp"
#include "base/output.hpp"
#include "trainer/common/session_timers.hpp"

namespace tureen::trainer {
namespace run_control_test {

namespace fs = std::filesystem;

/// The real clock is tested by a paused run of the program (train_program_test.cpp).
class Control : public testing::Test {
 protected:
  Control()
      : folder(fs::path(testing::TempDir()) /
               (std::string("tureen_control_") +
                testing::UnitTest::GetInstance()->current_test_info()->name())) {
    fs::remove_all(folder);
    fs::create_directories(folder);
  }
  ~Control() override { fs::remove_all(folder); }

  /// A clock that only the test and a waiting run advance.
  RunClock clock() {
    return {.now = [this] { return time; },
            .sleep = [this](std::chrono::milliseconds sleep) { time += sleep; }};
  }
  /// The command after the pause between readings.
  RunCommand next(RunControl& control) {
    time += pause;
    return control.command();
  }

  static constexpr std::chrono::milliseconds pause{100};
  std::chrono::steady_clock::time_point time{};
  fs::path folder, file = folder / "a.b.control";
};

TEST_F(Control, LiesBesideTheLog) { EXPECT_EQ(control_file(folder / "a.b.jsonl"), file); }

TEST_F(Control, PassesCommandsWhileTheRunIsInProgress) {
  EXPECT_EQ(read_command(file), std::nullopt);
  EXPECT_THROW(send_command(file, RunCommand::pause), UsageError);
  EXPECT_FALSE(fs::exists(file));
  {
    RunControl control(file, clock());
    for (const RunCommand command : {RunCommand::run, RunCommand::pause, RunCommand::finish}) {
      send_command(file, command);
      EXPECT_EQ(read_command(file), command);
      EXPECT_EQ(next(control), command);
    }
  }
  EXPECT_FALSE(fs::exists(file));
}

TEST_F(Control, ReadsTheFileAtMostTenTimesASecond) {
  RunControl control(file, clock());
  EXPECT_EQ(control.command(), RunCommand::run);
  send_command(file, RunCommand::finish);
  time += pause - std::chrono::milliseconds(1);
  EXPECT_EQ(control.command(), RunCommand::run);
  time += std::chrono::milliseconds(1);
  EXPECT_EQ(control.command(), RunCommand::finish);
}

TEST_F(Control, OtherContentsChangeNothing) {
  RunControl control(file, clock());
  send_command(file, RunCommand::finish);
  ASSERT_EQ(next(control), RunCommand::finish);
  for (const char* text :
       {"", "fin", "finish", "finish\nfinish\n", "hello, this is a long text\n"}) {
    write_file(file, std::string_view(text));
    EXPECT_EQ(read_command(file), std::nullopt) << text;
    EXPECT_EQ(next(control), RunCommand::finish) << text;
  }
  fs::remove(file);
  EXPECT_EQ(next(control), RunCommand::run);
}

TEST_F(Control, TakesOverOnlyControlFiles) {
  write_file(file, std::string_view("finish\n"));  // of a killed run
  EXPECT_EQ(RunControl(file).command(), RunCommand::run);
  write_file(file, std::string_view("Dear diary"));
  EXPECT_THROW(RunControl{file}, UsageError);
  EXPECT_EQ(fs::file_size(file), 10u);
  EXPECT_THROW(RunControl(folder / "none" / "a.control"), OutputError);
  fs::remove(file);
  fs::create_directories(file);
  EXPECT_EQ(read_command(file), std::nullopt);
  EXPECT_THROW(send_command(file, RunCommand::pause), OutputError);
  EXPECT_THROW(RunControl{file}, OutputError);
}

TEST_F(Control, WaitsWhilePaused) {
  RunControl control(file, clock());
  int waited = 0;
  EXPECT_EQ(control.wait_while_paused([&] { ++waited; }), 0);
  EXPECT_EQ(waited, 0);
  send_command(file, RunCommand::pause);
  ASSERT_EQ(next(control), RunCommand::pause);
  const double seconds = control.wait_while_paused([&] {
    if (++waited == 3) send_command(file, RunCommand::finish);
  });
  EXPECT_EQ(waited, 3);
  EXPECT_DOUBLE_EQ(seconds, 0.3);  // three pauses
  EXPECT_EQ(control.command(), RunCommand::finish);
  send_command(file, RunCommand::pause);
  ASSERT_EQ(next(control), RunCommand::pause);
  EXPECT_THROW(control.wait_while_paused([] { throw std::runtime_error("Ctrl-C"); }),
               std::runtime_error);
}

TEST(Snapshots, TakeFewPercentOfTheTime) {
  SnapshotTimer timer;
  EXPECT_TRUE(timer.due(0));
  timer.made(0, 0.001);
  EXPECT_FALSE(timer.due(1.9));
  EXPECT_TRUE(timer.due(2.1));
  timer.made(10, 11);  // a slow one: the next one after 33 s
  EXPECT_FALSE(timer.due(40));
  EXPECT_TRUE(timer.due(45));
}

}  // namespace run_control_test
}  // namespace tureen::trainer
