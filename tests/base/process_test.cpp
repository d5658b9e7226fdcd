#include "base/platform/process.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "base/platform/program_folder.hpp"

namespace tureen {
namespace process_test {

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

File temporary_file() { return {std::tmpfile(), &std::fclose}; }

std::string text_in(const File& file) {
  std::string text(1000, ' ');
  std::rewind(file.get());
  text.resize(std::fread(text.data(), 1, text.size(), file.get()));
  return text;
}

int code_of(const std::string& line) { return Process("sh", {"-c", line}, {}).wait(); }

TEST(Processes, ReturnTheirExitCodeOrSignal) {
  EXPECT_EQ(code_of("exit 0"), 0);
  EXPECT_EQ(code_of("exit 3"), 3);
  EXPECT_EQ(code_of("kill -9 $$"), 128 + 9);
}

TEST(Processes, ReceiveArgumentsLiterally) {
  EXPECT_EQ(output_of("printf", {"%s|", "a b", "$HOME", "", "'\""}), "a b|$HOME||'\"|");
}

TEST(Processes, OutputIsEmptyIfTheProgramFailsOrIsMissing) {
  EXPECT_EQ(output_of("sh", {"-c", "echo text; exit 1"}), "");
  EXPECT_EQ(output_of("/no/such/program", {}), "");
}

TEST(Processes, OutputMayBeLong) {
  EXPECT_EQ(output_of("sh", {"-c", "printf '%100000s' x"}), std::string(99999, ' ') + "x");
}

TEST(Processes, WriteToTheChosenStreams) {
  const File output = temporary_file(), errors = temporary_file();
  Process both("sh", {"-c", "echo out; echo problem >&2"},
               {.output = output.get(), .errors = errors.get()});
  EXPECT_EQ(both.wait(), 0);
  EXPECT_EQ(text_in(output), "out\n");
  EXPECT_EQ(text_in(errors), "problem\n");
}

TEST(Processes, ReadWhatIsSent) {
  const File output = temporary_file();
  Process copy("cat", {}, {.input = Process::Input::sent, .output = output.get()});
  for (const std::string part : {"first ", "", "second"})
    EXPECT_TRUE(copy.send(std::as_bytes(std::span(part))));
  EXPECT_FALSE(copy.ended());
  EXPECT_EQ(copy.wait(), 0);
  EXPECT_EQ(text_in(output), "first second");
}

TEST(Processes, OutputIsReceivedToItsEnd) {
  Process long_one("sh", {"-c", "head -c 300000 /dev/zero; printf end"},
                   {.input = Process::Input::none, .received = true});
  std::vector<std::byte> bytes(200'000);
  EXPECT_EQ(long_one.receive(bytes), 200'000u);
  EXPECT_EQ(long_one.receive(bytes), 100'003u);
  EXPECT_EQ(bytes[100'002], std::byte('d'));
  EXPECT_EQ(long_one.receive(bytes), 0u);
  EXPECT_EQ(long_one.wait(), 0);
  // One that is killed while nobody reads its output.
  Process endless("cat", {"/dev/zero"}, {.input = Process::Input::none, .received = true});
  EXPECT_EQ(endless.receive(bytes), bytes.size());
  endless.kill();
}

TEST(Processes, SendingToOneThatHasEndedFailsWithoutASignal) {
  Process brief("true", {}, {.input = Process::Input::sent});
  const std::string bytes(100000, 'x');
  bool is_sent = true;  // the connection may take the first bytes
  for (int i = 0; i < 100 && is_sent; ++i) is_sent = brief.send(std::as_bytes(std::span(bytes)));
  EXPECT_FALSE(is_sent);
  EXPECT_EQ(brief.wait(), 0);
}

TEST(Processes, WithoutInputReadNothing) {
  const File output = temporary_file();
  Process copy("cat", {}, {.input = Process::Input::none, .output = output.get()});
  EXPECT_EQ(copy.wait(), 0);
  EXPECT_EQ(text_in(output), "");
}

TEST(Processes, AreInterruptedAndKilled) {
  Process first("sleep", {"600"}, {.own_group = true});
  EXPECT_FALSE(first.ended());
  EXPECT_TRUE(first.interrupt());
  EXPECT_EQ(first.wait(), 128 + SIGINT);
  EXPECT_TRUE(first.ended());
  EXPECT_FALSE(first.interrupt());
  Process second("sleep", {"600"}, {});
  second.kill();
  EXPECT_TRUE(second.ended());
}

TEST(Processes, EndWithTheThreadThatStartsThem) {
  if (!is_on_path("setpriv")) GTEST_SKIP() << "no setpriv here";
  const File output = temporary_file();
  std::optional<Process> sleeper;
  std::thread([&] {
    sleeper.emplace("sh", std::vector<std::string>{"-c", "echo ready; exec sleep 600"},
                    Process::Options{.output = output.get(), .ends_with_us = true});
    while (text_in(output).empty() && !sleeper->ended()) {
    }
  }).join();
  EXPECT_EQ(sleeper->wait(), 128 + SIGKILL);
}

TEST(Processes, EndWithTheirObject) {
  const File output = temporary_file();
  {
    Process sleeper("sh", {"-c", "echo $$; exec sleep 600"},
                    {.output = output.get(), .ends_with_us = true});
    while (text_in(output).empty() && !sleeper.ended()) {
    }
  }
  EXPECT_EQ(kill(std::stoi(text_in(output)), 0), -1);  // no such process
}

TEST(Processes, EndAlsoIfTheyIgnoreSignals) {
  const File output = temporary_file();
  Process deaf("sh", {"-c", "trap '' INT; echo ready; while :; do sleep 1; done"},
               {.output = output.get(), .own_group = true});
  while (text_in(output).empty() && !deaf.ended()) {
  }
  deaf.end(std::chrono::milliseconds(50));
  EXPECT_EQ(deaf.wait(), 128 + SIGTERM);
}

TEST(Processes, OneThatCannotBeStartedHasTheSystemsReason) {
  for (const bool ends_with_us : {false, true})
    for (const auto input : {Process::Input::none, Process::Input::sent}) {
      try {
        Process("/no/such/program", {}, {.input = input, .ends_with_us = ends_with_us});
        FAIL() << "no exception";
      } catch (const std::system_error& error) {
        EXPECT_EQ(error.code(), std::errc::no_such_file_or_directory);
      }
    }
  // A folder, and a file that is no program.
  for (const char* program : {"/tmp", "/etc/passwd"})
    EXPECT_THROW(Process(program, {}, {.ends_with_us = true}), std::system_error) << program;
  EXPECT_THROW(become_program("/no/such/program", {}), std::system_error);
}

TEST(Processes, AreFoundOnThePathOrBesideThisOne) {
  EXPECT_TRUE(is_on_path("sh"));
  EXPECT_FALSE(is_on_path("no such program"));
  EXPECT_EQ(program_beside("no such program"), "no such program");
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe");
  EXPECT_EQ(program_beside(self.filename().string()), self.string());
}

}  // namespace process_test
}  // namespace tureen
