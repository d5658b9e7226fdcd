#include "trainer/common/run_control.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <fstream>
#include <functional>
#include <string>
#include <utility>

#include "base/error.hpp"
#include "base/output.hpp"
#include "trainer/common/session.hpp"

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

/// A run whose steps take as long as a test says.
class Timed final : public Trainable {
 public:
  int steps() const override { return steps_; }
  int steps_done() const override { return done_; }
  void set_steps(int steps) override { steps_ = steps; }
  StepReport step() override {
    ++done_;
    return {};
  }
  PrimitiveCount primitives() const override { return {PrimitiveKind::triangles, 1}; }
  std::vector<float> render(const Camera&) override { return {}; }
  std::span<const float, 3> background() const override { return background_; }
  void write_checkpoint(const fs::path&, double) const override {}

 private:
  int steps_ = 5000, done_ = 0;
  std::array<float, 3> background_{};
};

TEST(TimeFit, UsesTheTimeHoweverLongStepsTake) {
  constexpr double time = 100;
  // Seconds of a step, by the time so far: the first ones are slow, or they grow, or they shrink.
  const std::pair<const char*, std::function<double(double)>> kinds[] = {
      {"equal", [](double) { return 0.05; }},
      {"many", [](double) { return 0.002; }},
      {"few", [](double) { return 3.0; }},
      {"growing", [](double now) { return 0.01 + 0.002 * now; }},
      {"shrinking", [](double now) { return 0.2 / (1 + 0.1 * now); }},
      {"uneven", [](double now) { return std::fmod(now, 7) < 2 ? 0.3 : 0.02; }}};
  for (const auto& [name, cost] : kinds)
    for (const double begin : {0.0, 20.0, 97.0}) {
      Timed run;
      TimeFit fit(time, begin);
      double now = begin, schedule = 0;
      while (run.steps_done() < run.steps()) {
        const double seconds = cost(now);
        run.step();
        now += seconds;
        fit.after_step(run, 1, now);
        schedule = double(run.steps_done()) / run.steps();
        if (begin > 0.95 * time && now > 2 * time) break;  // no fit is left: the steps stay
      }
      if (begin > 0.95 * time) {
        EXPECT_EQ(run.steps(), 5000) << name;
        continue;
      }
      EXPECT_GE(now, 0.95 * time) << name;
      EXPECT_LE(now, 1.05 * time + cost(now)) << name;  // a step cannot be cut
      EXPECT_EQ(schedule, 1) << name;
      EXPECT_FALSE(fit.is_pending()) << name;
    }
}

TEST(TimeFit, ShowsProgressByTime) {
  const fs::path log = fs::path(testing::TempDir()) / "tureen_time_fit.jsonl";
  Timed run;
  double now = 1000, last = 0;
  SessionOptions options;
  options.log = log;
  options.seconds = 50;
  options.clock = [&] { return now; };
  options.progress = [&](const SessionStatus& status) {
    EXPECT_GE(status.fraction, last);  // it never runs backwards
    EXPECT_NEAR(status.fraction, (now - 1000) / 50, 1e-9);
    EXPECT_EQ(status.fits_steps, status.fraction < 0.95) << status.fraction;
    if (status.fits_steps) {
      EXPECT_NEAR(status.seconds_left, 50 - (now - 1000), 1e-9);
      EXPECT_THAT(describe(status), testing::HasSubstr("of about"));
    }
    last = status.fraction;
    now += 0.1 + 0.001 * status.step;
  };
  TrainingSession session(run, options);
  session.run();
  EXPECT_GE(session.seconds(), 0.95 * 50);
  EXPECT_LE(session.seconds(), 1.05 * 50);
  fs::remove(log);
}

}  // namespace run_control_test
}  // namespace tureen::trainer
