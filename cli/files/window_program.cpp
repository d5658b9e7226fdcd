#include "cli/files/window_program.hpp"

#include <system_error>

#include "base/error.hpp"
#include "base/platform/process.hpp"
#include "base/platform/program_folder.hpp"

namespace tureen::cli {

namespace {

constexpr const char* window_program = "tureen-view";

[[noreturn]] void fail_to_start(const std::system_error& reason) {
  if (reason.code() == std::errc::no_such_file_or_directory)
    throw UsageError("cannot find " + std::string(window_program) +
                         ", the window program, beside this program or on PATH",
                     "install libglfw3-dev and libimgui-dev and build it with ./dev demo, or draw "
                     "images with tureen render");
  throw OutputError({program_beside(window_program)}, "cannot be started");
}

}  // namespace

ExitCode become_window(const std::vector<std::string>& arguments) {
  try {
    become_program(program_beside(window_program), arguments);
  } catch (const std::system_error& reason) {
    fail_to_start(reason);
  }
}

void start_window(const std::vector<std::string>& arguments) {
  try {
    // A reader of this program's standard output must not wait for the window's end.
    const Process window(program_beside(window_program), arguments, {.output = nullptr});
  } catch (const std::system_error& reason) {
    fail_to_start(reason);
  }
}

}  // namespace tureen::cli
