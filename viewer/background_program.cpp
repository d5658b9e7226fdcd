#include "viewer/background_program.hpp"

#ifndef _WIN32
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#endif

#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <thread>
#include <utility>

#include "base/error.hpp"
#include "base/program_folder.hpp"

namespace tureen::viewer {

namespace {

/// Between two checks whether a program has ended.
constexpr std::chrono::milliseconds poll{50};

}  // namespace

#ifdef _WIN32

BackgroundProgram::BackgroundProgram(std::string program, const std::vector<std::string>&)
    : program_(std::move(program)) {
  throw OutputError({program_, {}, {}}, "cannot be started by the window on Windows",
                    "copy the command into a terminal");
}

bool BackgroundProgram::ended() { return true; }
bool BackgroundProgram::send(int) { return false; }

#else

BackgroundProgram::BackgroundProgram(std::string program, const std::vector<std::string>& arguments)
    : program_(std::move(program)), errors_(std::tmpfile()) {
  // No function here changes the strings.
  std::vector<char*> argv{const_cast<char*>(program_.c_str())};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  // Not a pipe: the program must be able to write when the window is closed.
  if (errors_) posix_spawn_file_actions_adddup2(&actions, fileno(errors_.get()), STDERR_FILENO);
  // A group of its own: Ctrl-C in the window's terminal ends the window only.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF);
  posix_spawnattr_setpgroup(&attributes, 0);
  // A shell starts programs of the background with SIGINT ignored, and children inherit this.
  sigset_t ending;
  sigemptyset(&ending);
  for (const int signal : {SIGINT, SIGTERM}) sigaddset(&ending, signal);
  posix_spawnattr_setsigdefault(&attributes, &ending);
  pid_t process = 0;
  const int reason =
      posix_spawnp(&process, program_.c_str(), &actions, &attributes, argv.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (reason != 0)
    throw OutputError({program_, {}, {}}, std::string("cannot be started: ") + strerror(reason));
  process_ = process;
}

bool BackgroundProgram::ended() {
  int status = 0;
  if (!exit_code_ && ::waitpid(process_, &status, WNOHANG) == process_)
    exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return exit_code_.has_value();
}

bool BackgroundProgram::send(int signal) {
  // Not after its end, when another process may have its number.
  return !ended() && ::kill(-process_, signal) == 0;
}

#endif

bool BackgroundProgram::interrupt() { return send(SIGINT); }

void BackgroundProgram::end(std::chrono::milliseconds patience) {
#ifndef _WIN32
  for (const int signal : {SIGINT, SIGTERM, SIGKILL}) {
    send(signal);
    const auto until = std::chrono::steady_clock::now() + patience;
    while (!ended() && (signal == SIGKILL || std::chrono::steady_clock::now() < until))
      std::this_thread::sleep_for(poll);
  }
#endif
}

std::optional<std::string> BackgroundProgram::failure() {
  if (!ended() || exit_code_ == 0) return {};
  std::string last = program_ + " ended with exit code " + std::to_string(exit_code_.value_or(1));
  // The last line of a program that was ended from outside is not the reason.
  if (exit_code_ > 128)
    return program_ + " was ended by signal " + std::to_string(*exit_code_ - 128);
  if (!errors_) return last;
  std::rewind(errors_.get());
  char line[4096];
  while (std::fgets(line, sizeof line, errors_.get())) {
    std::string text = line;
    while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
    if (!text.empty()) last = text;
  }
  return last;
}

void run_to_end(const std::string& program, const std::vector<std::string>& arguments,
                const std::filesystem::path& output, const std::function<void()>& check) {
  BackgroundProgram running(program, arguments);
  try {
    while (!running.ended()) {
      check();
      std::this_thread::sleep_for(poll);
    }
  } catch (...) {
    running.end();
    throw;
  }
  if (const auto failure = running.failure())
    throw OutputError({output.string(), {}, {}}, *failure);
}

std::string tureen_program() {
  std::error_code ignored;
  if (const auto folder = program_folder())
    if (const auto beside = *folder / "tureen"; std::filesystem::exists(beside, ignored))
      return beside.string();
  return "tureen";
}

}  // namespace tureen::viewer
