// The files of `tureen train` after a signal at any moment, or on a full disk: the old soup or the
// new one, complete, and a checkpoint. Resuming from it gives the result of an uninterrupted run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <random>
#include <utility>

#include "tests/cli/faults.hpp"
#include "tests/cli/nobody.hpp"
#include "tests/cli/train_fixture.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/measured.hpp"

namespace tureen {
namespace train_faults_program_test {

using test::Names;
namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using test::ChildResult;
using test::Moment;
using test::SmallDisk;
using testing::AnyOf;
using testing::Each;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

class TrainFaults : public test::Train {
 protected:
  static constexpr const char* steps = "60";
  const std::vector<std::string> often{"--checkpoint-every", "9"};

  void SetUp() override {
    Train::SetUp();
    if (prepared.empty()) {
      ASSERT_NO_FATAL_FAILURE(prepare());
      const fs::path copy =
          fs::path(testing::TempDir()) / ("tureen_prepared_" + std::to_string(::getpid()));
      fs::remove_all(copy);
      fs::copy(folder, copy, fs::copy_options::recursive);
      prepared = copy;
    } else {
      fs::copy(prepared, folder, fs::copy_options::recursive);
    }
    before = bytes("old/ball.glb");
    after = bytes("whole/ball.glb");
  }

  static void TearDownTestSuite() { fs::remove_all(std::exchange(prepared, {})); }

  /// Makes the dataset, and finished runs of two seeds in the folders "old" and "whole".
  void prepare() const {
    make_dataset();
    // The file contains its name, so both have the same name.
    for (const char* name : {"old", "whole"}) fs::create_directory(folder / name);
    for (const std::string name : {"old", "whole"}) {
      const Clock::time_point begin = Clock::now();
      std::vector<std::string> more = often;
      if (name == "old") more.insert(more.end(), {"--seed", "1"});
      ASSERT_EQ(train(name + "/ball.glb", more, steps).exit_code, 0);
      run_time = std::min(
          run_time, std::chrono::duration_cast<std::chrono::microseconds>(Clock::now() - begin));
    }
    ASSERT_NE(bytes("old/ball.glb"), bytes("whole/ball.glb"));
  }

  /// Restores the files of the finished run "old".
  void put_old() const {
    for (const std::string& name : test::names_in(folder))
      if (name.rfind("ball.", 0) == 0) fs::remove_all(folder / name);
    for (const char* name : {"ball.glb", "ball.jsonl"})
      fs::copy_file(folder / "old" / name, folder / name);
  }

  /// Trains from the present files to the end. The result must equal that of the undisturbed run.
  void expect_to_end_as_if_left_alone() {
    std::vector<std::string> more;
    const bool resumes = exists("ball.checkpoint");
    if (resumes) more.emplace_back("--resume");
    const ChildResult result = train("ball.glb", more, steps);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const bool is_same = bytes("ball.glb") == after;
    EXPECT_TRUE(is_same) << "differs from the undisturbed run";
    resumed += resumes;
    resumed_to_end += resumes && is_same;
    EXPECT_FALSE(exists("ball.checkpoint"));
    const std::string log = bytes("ball.jsonl"), whole = bytes("whole/ball.jsonl");
    EXPECT_EQ(std::count(log.begin(), log.end(), '\n'),
              std::count(whole.begin(), whole.end(), '\n'))
        << "each step once";
  }

  /// Ends a run once its first checkpoint is complete, and resumes it to its end.
  void expect_to_resume(int signal) {
    put_old();
    const test::Lookout lookout({.until = test::Moment::Until::replaced, .path = "ball.checkpoint"},
                                folder);
    test::Child child(arguments("ball.glb", often, steps), folder);
    EXPECT_TRUE(lookout.wait_for(child));
    test::end_by(signal, child);
    child.wait();
    test::remove_temporaries(folder);
    fs::remove(folder / "ball.lock");
    EXPECT_TRUE(exists("ball.checkpoint"));
    expect_to_end_as_if_left_alone();
  }

  /// Ends training runs at moments from their start to beyond their end, also while they resume;
  /// for each signal, `timed` moments at any time, and those of the events. After up to three
  /// interruptions in a row, the run may finish.
  void expect_survival(int timed);

  std::string before, after;
  static inline fs::path prepared;  // a folder with the files of prepare(); empty before
  static inline auto run_time = std::chrono::microseconds::max();  // the shortest
  // Runs with --resume, and those of them that ended with an identical file.
  int resumed = 0, resumed_to_end = 0;
};

void TrainFaults::expect_survival(int timed) {
  constexpr unsigned seed = 11;
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::minstd_rand random(seed);
  int all = 0, all_cut_short = 0, half_written = 0;
  // A file may be complete before the test notices that it is written: in up to half of the cases
  // with six programs on two cores. The test repeats that moment. It is very unlikely that all 40
  // repetitions miss it.
  int tries_left = 40;
  for (const int signal : {SIGKILL, SIGINT}) {
    // Moments: while each file is written; after the soup replaced the old one; and at any time.
    // Early and late times are shuffled, because a resumed run is shorter than a whole one.
    std::vector<Moment> moments;
    for (const char* name : {"ball.checkpoint", "ball.checkpoint", "ball.glb"})
      moments.push_back({.after = run_time * (random() % 100) / 400,
                         .until = Moment::Until::written,
                         .path = name});
    moments.push_back({.until = Moment::Until::replaced, .path = "ball.glb"});
    std::vector<Moment> any = test::moments_of(run_time, timed, random);
    std::shuffle(any.begin(), any.end(), random);
    moments.insert(moments.end(), any.begin(), any.end());

    int cut_short = 0, replaced = 0, in_a_row = 0;
    put_old();
    for (std::size_t i = 0; i < moments.size(); ++i) {
      const Moment moment = moments[i];
      SCOPED_TRACE("signal " + std::to_string(signal) + " after " +
                   std::to_string(moment.after.count()) + " us " + moment.path);
      std::vector<std::string> more = often;
      const bool resumes = exists("ball.checkpoint");
      if (resumes) more.emplace_back("--resume");
      resumed += resumes;
      const test::Lookout lookout(moment, folder);
      test::Child child(arguments("ball.glb", more, steps), folder);
      const bool came = lookout.wait_for(child);
      if (!came && moment.until == Moment::Until::written && tries_left-- > 0)
        moments.push_back(moment);
      test::end_by(signal, child);
      const ChildResult result = child.wait();

      const std::string now = bytes("ball.glb");
      const bool is_new = now == after;
      EXPECT_TRUE(is_new || now == before) << "the soup is neither the old nor the new";
      if (moment.until == Moment::Until::replaced) {
        EXPECT_TRUE(is_new);
      }
      replaced += is_new;
      const int temporaries = test::remove_temporaries(folder);
      if (signal == SIGKILL) {
        if (came && moment.until == Moment::Until::written) {
          EXPECT_EQ(temporaries, 1);
        }
        half_written += temporaries;
        fs::remove(folder / "ball.lock");  // no process holds it
      } else {
        EXPECT_EQ(temporaries, 0);
        EXPECT_FALSE(exists("ball.lock"));
      }
      if (result.exit_code == 0) {
        EXPECT_TRUE(is_new);
        EXPECT_FALSE(exists("ball.checkpoint"));
        resumed_to_end += resumes && is_new;
      } else {
        ++cut_short;
        // Until the program handles Ctrl-C, SIGINT ends it like any other program.
        EXPECT_THAT(result.exit_code, AnyOf(-1, signal == SIGINT ? 5 : -1)) << result.err;
      }
      if (result.exit_code == 5) {
        // Before the first step there is no checkpoint, and the message does not mention --resume.
        EXPECT_TRUE(is_new || exists("ball.checkpoint") ||
                    result.err.find("--resume") == std::string::npos)
            << result.err;
      }
      const bool done = is_new && !exists("ball.checkpoint");
      if (!done && ++in_a_row < 3) continue;
      if (!done) expect_to_end_as_if_left_alone();
      put_old();
      in_a_row = 0;
    }
    expect_to_end_as_if_left_alone();
    expect_to_resume(signal);

    const int sent = int(moments.size());
    all += sent;
    all_cut_short += cut_short;
    EXPECT_GT(cut_short, 0) << "no moment was early enough";
    EXPECT_LT(replaced, sent) << "the old one never remained";
    EXPECT_GT(replaced, 0) << "no moment was late enough";
    const std::string name = signal == SIGKILL ? "SIGKILL" : "SIGINT";
    test::leave_measured("signals", {{"what", "train over a file"},
                                     {"signal", name},
                                     {"sent", sent},
                                     {"cut_short", cut_short},
                                     {"old", sent - replaced},
                                     {"new", replaced}});
  }
  EXPECT_GT(resumed, 0) << "no run resumed from a checkpoint";
  EXPECT_GT(resumed_to_end, 0) << "no resumed run finished";
  EXPECT_GT(half_written, 0) << "no file was being written when a run was killed";
  test::leave_measured("resumed", {{"sent", all},
                                   {"cut_short", all_cut_short},
                                   {"resumed", resumed},
                                   {"resumed_to_end", resumed_to_end},
                                   {"half_written", half_written},
                                   {"steps", std::stoi(steps)}});
}

TEST_F(TrainFaults, ASignalAtAnyMomentLeavesTheOldOrTheNewAndIsAsIfItHadNotBeen) {
  expect_survival(4);
}

/// More moments.
using ThoroughTrainFaults = TrainFaults;
TEST_F(ThoroughTrainFaults, ASignalAtAnyMomentLeavesTheOldOrTheNewAndIsAsIfItHadNotBeen) {
  expect_survival(16);
}

TEST_F(TrainFaults, AFullDiskLeavesTheOldSoupAndTheLastCheckpoint) {
  // Messages and log take less than this, in bytes; a checkpoint, an image and a soup take more.
  constexpr rlim_t little = 2000;
  const auto expect_full = [&](const std::vector<std::string>& more, const std::string& file,
                               rlim_t room) {
    SCOPED_TRACE(file);
    const std::string checkpoint = bytes("ball.checkpoint");
    ChildResult result;
    {
      const SmallDisk small(room);
      result = train("ball.glb", more, steps);
    }
    EXPECT_EQ(result.exit_code, 5);
    EXPECT_THAT(result.err, Names(file, "File too large"));
    EXPECT_TRUE(bytes("ball.glb") == before) << "the old soup changed";
    EXPECT_TRUE(bytes("ball.checkpoint") == checkpoint) << "the checkpoint changed";
    EXPECT_THAT(test::names_in(folder), Each(Not(AnyOf(HasSubstr(".tmp"), EndsWith(".lock")))));
  };
  put_old();
  expect_full(often, "ball.checkpoint", little);

  fs::create_directory(folder / "ball.previews");
  const std::string image = "ball.previews/step_00000010.png";
  write(image, "an older image");
  expect_full({"--preview-every", "10"}, image, little);
  EXPECT_EQ(bytes(image), "an older image");

  ASSERT_GT(after.size(), 2 * little);
  expect_full({}, "ball.glb", after.size() - 1);

  // The disk is full when a resumed run writes its checkpoint. The old checkpoint stays, and the
  // next run ends as if the disk had never been full.
  put_old();
  // This run ends after the third of six checkpoints: a folder has the name of its image of step
  // 30.
  fs::create_directories(folder / "ball.previews/step_00000030.png");
  std::vector<std::string> until_30 = often;
  until_30.insert(until_30.end(), {"--preview-every", "30"});
  const ChildResult ended = train("ball.glb", until_30, steps);
  EXPECT_EQ(ended.exit_code, 5);
  EXPECT_THAT(ended.err, Names("step_00000030.png"));
  ASSERT_TRUE(exists("ball.checkpoint"));
  std::vector<std::string> resume = often;
  resume.emplace_back("--resume");
  expect_full(resume, "ball.checkpoint", little);
  expect_full({"--resume"}, "ball.glb", after.size() - 1);
  expect_to_end_as_if_left_alone();
}

TEST_F(TrainFaults, ADiskWithoutSpaceLeavesTheOldSoup) {
  fs::copy(folder / "old", folder / "disk");
  // The size of the present files, and less than a checkpoint.
  int kilobytes = 16;
  for (const std::string& name : test::names_in(folder / "disk"))
    kilobytes += int(fs::file_size(folder / "disk" / name) / 4096 + 1) * 4;
  const ChildResult result =
      test::run_on_disk(kilobytes, arguments("disk/ball.glb", often, steps), folder);
  if (result.exit_code == test::no_disk)
    GTEST_SKIP() << "cannot mount a small disk: " << result.err;
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_THAT(result.err, Names("ball.checkpoint", "No space left on device"));
  EXPECT_EQ(test::names_in(folder / "after"), test::names_in(folder / "disk"));
  EXPECT_TRUE(bytes("after/ball.glb") == before);
}

TEST_F(TrainFaults, WhereNothingMayBeWrittenNothingIs) {
  fs::copy(folder / "old", folder / "locked");
  const auto files = test::contents_of(folder / "locked");
  fs::permissions(folder, fs::perms::all);
  test::make_streams_for_all(folder);
  for (const auto& [name, content] : files)  // only the folder forbids writing
    fs::permissions(folder / "locked" / name, fs::perms(0666));
  fs::permissions(folder / "locked", fs::perms(0555));
  ChildResult result;
  {
    const test::Nobody nobody;
    if (::eaccess(TUREEN_PROGRAM, X_OK) != 0)
      GTEST_SKIP() << TUREEN_PROGRAM << " is not executable for every user";
    result = train("locked/ball.glb", often, steps);
  }
  fs::permissions(folder / "locked", fs::perms::owner_all);
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_THAT(result.err, Names("Permission denied"));
  EXPECT_TRUE(test::contents_of(folder / "locked") == files);
}

}  // namespace train_faults_program_test
}  // namespace tureen
