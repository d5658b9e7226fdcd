// `tureen view`: starts the window, a program of its own, so that this one needs no window
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

/// Beside this program, or wherever PATH has it.
std::string find_window_program() {
  std::error_code ignored;
  if (const auto folder = program_folder())
    if (const auto beside = *folder / window_program; std::filesystem::exists(beside, ignored))
      return beside.string();
  return window_program;
}

/// Becomes the other program; comes back only where that cannot be.
ExitCode become_window(const std::vector<std::string>& arguments) {
  const std::string program = find_window_program();
  std::vector<char*> argv{const_cast<char*>(program.c_str())};  // execvp changes none of them
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
  // All that follows, --help too, is the other program's.
  program.add_command("view", "Explore a scene in a window").does_with_rest(become_window);
}

}  // namespace tureen::cli
