// Programs that the window starts.
#include "viewer/background_program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/types.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "tests/support/errors.hpp"

namespace tureen::viewer {
namespace background_program_test {

namespace fs = std::filesystem;

void wait(BackgroundProgram& program) {
  while (!program.ended()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
}

TEST(BackgroundPrograms, ReportTheLastLineOfAnError) {
  BackgroundProgram bad("sh", {"-c", "echo first >&2; echo the reason >&2; exit 3"});
  wait(bad);
  EXPECT_EQ(bad.failure(), "the reason");
  BackgroundProgram silent("sh", {"-c", "exit 4"});
  wait(silent);
  EXPECT_EQ(silent.failure(), "sh ended with exit code 4");
}

TEST(BackgroundPrograms, OneThatSucceedsHasNoFailure) {
  BackgroundProgram good("sh", {"-c", "echo progress >&2"});
  wait(good);
  EXPECT_EQ(good.failure(), std::nullopt);
}

/// The process that `program` starts. It writes the number of this process into `file`.
pid_t started_by(BackgroundProgram& program, const fs::path& file) {
  pid_t process = 0;
  while (!(std::ifstream(file) >> process) && !program.ended())
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  return process;
}

/// Whether the process ends within 10 seconds. A zombie, which only its parent can remove, counts.
bool ends(pid_t process) {
  for (int i = 0; i < 2000; ++i) {
    std::string number, name, status;
    std::ifstream stat("/proc/" + std::to_string(process) + "/stat");
    const bool is_zombie = bool(stat >> number >> name >> status) && status == "Z";
    if (is_zombie || ::kill(process, 0) != 0) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}

fs::path new_file(const std::string& name) {
  fs::path file = fs::path(testing::TempDir()) / name;
  fs::remove(file);
  return file;
}

/// A shell that starts `sleep`, writes its process into `file` and waits for it.
std::vector<std::string> sleeping(const std::string& before, const fs::path& file) {
  const std::string path = file.string();
  return {"-c", before + "sleep 600 & echo $! > '" + path + ".new'; mv '" + path + ".new' '" +
                    path + "'; while true; do wait; done"};
}

// In the foreground, because a shell starts programs of its background with SIGINT ignored.
TEST(BackgroundPrograms, AreInterruptedWithThoseThatTheyStarted) {
  const fs::path file = new_file("interrupted.pid");
  BackgroundProgram program(
      "sh", {"-c", "sh -c 'echo $$ > \"$0\"; exec sleep 600' '" + file.string() + "'; exit 0"});
  const pid_t started = started_by(program, file);
  ASSERT_GT(started, 0);
  EXPECT_TRUE(program.interrupt());
  wait(program);
  EXPECT_EQ(program.failure(), "sh was ended by signal 2");
  EXPECT_TRUE(ends(started));
  EXPECT_FALSE(program.interrupt());
}

/// A shell starts the programs of its background so.
TEST(BackgroundPrograms, AreInterruptedWhereTheWindowIgnoresTheSignal) {
  const auto before = std::signal(SIGINT, SIG_IGN);
  BackgroundProgram program("sleep", {"600"});
  std::signal(SIGINT, before);
  EXPECT_TRUE(program.interrupt());
  wait(program);
  EXPECT_EQ(program.failure(), "sleep was ended by signal 2");
}

TEST(BackgroundPrograms, EndAlsoIfTheyIgnoreSignals) {
  for (const auto& [ignored, ended_by] : {std::pair("INT", 15), std::pair("INT TERM", 9)}) {
    const fs::path file = new_file("ignoring.pid");
    BackgroundProgram program("sh", sleeping(std::string("trap '' ") + ignored + "; ", file));
    const pid_t started = started_by(program, file);
    ASSERT_GT(started, 0);
    program.end(std::chrono::milliseconds(100));
    EXPECT_EQ(program.failure(), "sh was ended by signal " + std::to_string(ended_by));
    EXPECT_TRUE(ends(started));
  }
}

TEST(BackgroundPrograms, RunToTheirEndOrUntilTheCheckThrows) {
  run_to_end("sh", {"-c", "exit 0"}, "page.html", [] {});
  EXPECT_THAT(test::error_of<OutputError>([] {
                run_to_end("sh", {"-c", "echo the reason >&2; exit 3"}, "page.html", [] {});
              }),
              test::ErrorAt("page.html", "the reason"));
  struct Cancelled {};
  EXPECT_THROW(run_to_end("sleep", {"600"}, "page.html", [] { throw Cancelled(); }), Cancelled);
}

TEST(BackgroundPrograms, AMissingOneIsNamed) {
  EXPECT_THAT(test::error_of<OutputError>([] { BackgroundProgram("/no/such/program", {}); }),
              test::ErrorIn("/no/such/program"));
}

}  // namespace background_program_test
}  // namespace tureen::viewer
