#include "trainer/common/run_control.hpp"

#include <array>
#include <span>
#include <string_view>
#include <utility>

#include "base/error.hpp"
#include "base/existing_path.hpp"
#include "base/input.hpp"
#include "base/output.hpp"

namespace tureen::trainer {

namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds reading_pause(100);

constexpr std::array<std::pair<RunCommand, std::string_view>, 3> command_words{
    {{RunCommand::run, "run\n"}, {RunCommand::pause, "pause\n"}, {RunCommand::finish, "finish\n"}}};

void write_command(const fs::path& file, RunCommand command) {
  for (const auto& [each, word] : command_words)
    if (each == command) write_file(file, word);
}

}  // namespace

fs::path control_file(const fs::path& log) { return fs::path(log).replace_extension(".control"); }

std::optional<RunCommand> read_command(const fs::path& file) {
  try {
    Input input = Input::open(file);
    std::array<char, 16> buffer{};  // longer than all words
    const std::size_t count = input.read_some(std::as_writable_bytes(std::span(buffer)));
    for (const auto& [command, word] : command_words)
      if (word == std::string_view(buffer.data(), count)) return command;
  } catch (const Error&) {
  }
  return std::nullopt;
}

void send_command(const fs::path& file, RunCommand command) {
  if (is_missing(file))
    throw UsageError("no run is in progress: " + file.string() + " does not exist");
  write_command(file, command);
}

RunControl::RunControl(fs::path file, RunClock clock)
    : file_(std::move(file)), clock_(std::move(clock)) {
  std::error_code ignored;
  if (fs::is_regular_file(file_, ignored) && !read_command(file_))
    throw UsageError(file_.string() + " exists and is not a control file of a training run",
                     "choose another name");
  write_command(file_, RunCommand::run);
}

RunControl::~RunControl() {
  std::error_code ignored;
  fs::remove(file_, ignored);
}

RunCommand RunControl::command() {
  const auto now = clock_.now();
  if (now < next_) return last_;
  next_ = now + reading_pause;
  last_ = read_command(file_).value_or(is_missing(file_) ? RunCommand::run : last_);
  return last_;
}

double RunControl::wait_while_paused(const std::function<void()>& waiting) {
  const auto begin = clock_.now();
  if (command() != RunCommand::pause) return 0;
  while (command() == RunCommand::pause) {
    waiting();
    clock_.sleep(reading_pause);
  }
  return std::chrono::duration<double>(clock_.now() - begin).count();
}

}  // namespace tureen::trainer
