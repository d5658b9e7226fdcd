// `tureen view`: starts the window. It is a separate program, so that this one needs no window
// libraries.
#include <cerrno>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>
#ifdef _WIN32
#include <process.h>
#else
#include <unistd.h>
#endif

#include "base/error.hpp"
#include "cli/commands.hpp"
#include "cli/files/program_folder.hpp"

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

/// Replaces this process by the window program; on Windows, runs it and returns its exit code.
/// Throws if it cannot be started.
ExitCode become_window(const std::vector<std::string>& arguments) {
  const std::string program = find_window_program();
  std::vector<char*> argv{const_cast<char*>(program.c_str())};  // execvp does not change them
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
#ifdef _WIN32
  const auto status = _spawnvp(_P_WAIT, program.c_str(), argv.data());
  if (status >= 0) return static_cast<ExitCode>(status);
#else
  execvp(program.c_str(), argv.data());
#endif
  if (errno == ENOENT)
    throw UsageError(
        "cannot find " + std::string(window_program) +
            ", the window program, beside this program or on PATH",
        "install libglfw3-dev and libimgui-dev and build it with ./dev demo, or draw images with "
        "tureen render");
  throw OutputError({program, {}, {}}, "cannot be started");
}

}  // namespace

void add_view(Command& program) {
  // All further arguments, including --help, go to the window program.
  program.add_command("view", "Explore a scene in a window").does_with_rest(become_window);
}

}  // namespace tureen::cli
