// Programs that the window starts.
#include "viewer/background_program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "base/error.hpp"
#include "tests/support/errors.hpp"

namespace tureen::viewer {
namespace background_program_test {

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

TEST(BackgroundPrograms, AreInterruptedWithThoseThatTheyStarted) {
  BackgroundProgram program("sh", {"-c", "sleep 600; exit 0"});
  program.interrupt();
  wait(program);
  EXPECT_EQ(program.failure(), "sh was ended by signal 2");
}

TEST(BackgroundPrograms, RunToTheirEndOrUntilTheCheckThrows) {
  run_to_end("sh", {"-c", "exit 0"}, [] {});
  EXPECT_THAT(test::error_of<UsageError>([] {
                run_to_end("sh", {"-c", "echo the reason >&2; exit 3"}, [] {});
              }),
              test::ErrorAt("", "the reason"));
  struct Cancelled {};
  EXPECT_THROW(run_to_end("sleep", {"600"}, [] { throw Cancelled(); }), Cancelled);
}

TEST(BackgroundPrograms, AMissingOneIsNamed) {
  EXPECT_THAT(test::error_of<OutputError>([] { BackgroundProgram("/no/such/program", {}); }),
              test::ErrorIn("/no/such/program"));
}

}  // namespace background_program_test
}  // namespace tureen::viewer
