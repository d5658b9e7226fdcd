#include "viewer/background_program.hpp"

#include <chrono>
#include <system_error>
#include <thread>
#include <utility>

#include "base/error.hpp"
#include "base/platform/program_folder.hpp"

namespace tureen::viewer {

BackgroundProgram::BackgroundProgram(std::string program, const std::vector<std::string>& arguments)
    : program_(std::move(program)), errors_(std::tmpfile()) {
  // The errors go to a file, as the program must be able to write when the window is closed.
  try {
    process_.emplace(program_, arguments,
                     Process::Options{.input = Process::Input::none,
                                      .output = nullptr,
                                      .errors = errors_ ? errors_.get() : stderr,
                                      .own_group = true});
  } catch (const std::system_error& reason) {
    throw OutputError({program_, {}, {}}, "cannot be started: " + reason.code().message());
  }
}

std::optional<std::string> BackgroundProgram::failure() {
  if (!ended()) return {};
  const int exit_code = process_->wait();
  if (exit_code == 0) return {};
  // The last line of a program that was ended from outside is not the reason.
  if (exit_code > 128) return program_ + " was ended by signal " + std::to_string(exit_code - 128);
  std::string last = program_ + " ended with exit code " + std::to_string(exit_code);
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
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  } catch (...) {
    running.end();
    throw;
  }
  if (const auto failure = running.failure())
    throw OutputError({output.string(), {}, {}}, *failure);
}

std::string tureen_program() { return program_beside("tureen"); }

}  // namespace tureen::viewer
