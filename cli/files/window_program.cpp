#include "cli/files/window_program.hpp"

#include <cerrno>
#include <filesystem>
#ifdef _WIN32
#include <process.h>
#else
#include <fcntl.h>
#include <spawn.h>
#include <unistd.h>
#endif

#include "base/error.hpp"
#include "base/program_folder.hpp"

namespace tureen::cli {

namespace {

constexpr const char* window_program = "tureen-view";

/// The path beside this program; otherwise the name alone, for a search on PATH.
std::string find_window_program() {
  std::error_code ignored;
  if (const auto folder = program_folder())
    if (const auto beside = *folder / window_program; std::filesystem::exists(beside, ignored))
      return beside.string();
  return window_program;
}

/// Null-terminated. The strings must outlive the result; no function here changes them.
std::vector<char*> argv_of(const std::string& program, const std::vector<std::string>& arguments) {
  std::vector<char*> argv{const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  return argv;
}

[[noreturn]] void fail_to_start(const std::string& program, int reason) {
  if (reason == ENOENT)
    throw UsageError(
        "cannot find " + std::string(window_program) +
            ", the window program, beside this program or on PATH",
        "install libglfw3-dev and libimgui-dev and build it with ./dev demo, or draw images with "
        "tureen render");
  throw OutputError({program, {}, {}}, "cannot be started");
}

}  // namespace

ExitCode become_window(const std::vector<std::string>& arguments) {
  const std::string program = find_window_program();
  const std::vector<char*> argv = argv_of(program, arguments);
#ifdef _WIN32
  const auto status = _spawnvp(_P_WAIT, program.c_str(), argv.data());
  if (status >= 0) return static_cast<ExitCode>(status);
#else
  execvp(program.c_str(), argv.data());
#endif
  fail_to_start(program, errno);
}

void start_window(const std::vector<std::string>& arguments) {
  const std::string program = find_window_program();
  const std::vector<char*> argv = argv_of(program, arguments);
#ifdef _WIN32
  if (_spawnvp(_P_NOWAIT, program.c_str(), argv.data()) < 0) fail_to_start(program, errno);
#else
  // A reader of this program's standard output must not wait for the window's end.
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  pid_t process = 0;
  const int reason =
      posix_spawnp(&process, program.c_str(), &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (reason != 0) fail_to_start(program, reason);
#endif
}

}  // namespace tureen::cli
