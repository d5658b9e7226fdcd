#include "jobs/cameras/camera_work.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <system_error>
#include <thread>
#include <utility>

#include "base/error.hpp"
#include "base/input.hpp"
#include "base/output.hpp"
#include "base/platform/process.hpp"
#include "base/steady_seconds.hpp"

namespace tureen {

namespace {

namespace fs = std::filesystem;

constexpr const char* inputs_file = "photographs.txt";

/// The complete lines that a growing file has got since the last call.
class NewLines {
 public:
  explicit NewLines(const fs::path& file) : stream_(file, std::ios::binary) {}

  void each(const std::function<void(std::string_view)>& act) {
    stream_.clear();
    stream_.seekg(0, std::ios::cur);  // some libraries remember the end of a file
    for (std::string part; std::getline(stream_, part);) {
      line_ += part;
      if (stream_.eof()) return;  // the end of the line is not written yet
      act(std::exchange(line_, {}));
    }
  }

 private:
  std::ifstream stream_;
  std::string line_;
};

/// The last lines of a log that say something, for an error.
std::string end_of(const fs::path& log) {
  std::vector<std::string> lines;
  NewLines(log).each([&](std::string_view line) {
    if (line.find_first_not_of(" =-") != std::string_view::npos) lines.emplace_back(line);
  });
  std::string text;
  for (std::size_t i = lines.size() - std::min<std::size_t>(lines.size(), 3); i < lines.size(); ++i)
    text += (text.empty() ? "" : " / ") + lines[i].substr(lines[i].find_first_not_of(' '));
  return text;
}

void require_colmap(const std::string& colmap) {
  std::error_code ignored;
  const bool is_path = colmap.find('/') != std::string::npos;
  if (is_path ? fs::is_regular_file(colmap, ignored) : is_on_path(colmap)) return;
  if (colmap != "colmap") throw UsageError("--colmap " + colmap + ": there is no such program");
  throw UsageError(
      "COLMAP, which finds the cameras of photographs, is not installed",
      "install it, on Debian and Ubuntu with: sudo apt-get install --no-install-recommends colmap");
}

}  // namespace

CameraWork::CameraWork(CameraWorkOptions options, const CameraEvents& events)
    : options_(std::move(options)), events_(events) {
  require_colmap(options_.colmap);
  const fs::path& folder = options_.folder;
  std::error_code ignored;
  const bool is_work = fs::exists(folder / inputs_file, ignored);
  if (!is_work && fs::exists(folder, ignored) && !fs::is_empty(folder, ignored))
    throw UsageError(folder.string() + " exists and is no work folder", "choose another name");
  make_folder(folder);
  lock_.emplace(folder / "lock");
  if (!lock_->is_held()) throw UsageError("another program uses " + folder.string());
  if (is_work && Input::open(folder / inputs_file).read_text() == options_.inputs) {
    events_.note("continuing in " + folder.string());
  } else if (is_work) {
    events_.note("starting again: " + folder.string() + " belongs to other photographs");
    std::vector<fs::path> old;
    for (const auto& entry : fs::directory_iterator(folder, ignored))
      if (entry.path().filename() != "lock") old.push_back(entry.path());
    for (const fs::path& path : old) fs::remove_all(path, ignored);
  }
  for (const char* name : {"done", "logs", "pairs"}) make_folder(folder / name);
  write_file(folder / inputs_file, options_.inputs);
}

void CameraWork::progress(const char* title, double forecast, double fraction) {
  const double here = forecast * std::clamp(fraction, 0.0, 1.0);
  const double spent = spent_ + steady_seconds() - begun_;
  total_ = std::max(total_, done_ + forecast);
  // The ratio of real to forecast seconds is noise until a fiftieth is done.
  const double measured = measured_ + here;
  const double ratio = measured > 0.02 * total_ ? spent / measured : 1.0;
  const double done = done_ + here, now = steady_seconds();
  if (done > told_.done)
    told_ = {.done = done,
             .fraction = std::max(told_.fraction, total_ > 0 ? done / total_ : 0.0),
             .left = ratio * (total_ - done),
             .at = now};
  events_.progress(title, told_.fraction, std::max(0.0, told_.left - (now - told_.at)));
}

int CameraWork::run_once(const std::string& name, const char* title, double forecast,
                         const Work& work) {
  const fs::path marker = options_.folder / "done" / name;
  std::error_code ignored;
  if (!fs::exists(marker, ignored)) {
    begun_ = steady_seconds();
    const int code = work([&](double fraction) { progress(title, forecast, fraction); });
    write_file(marker, std::to_string(code));
    measured_ += forecast;
    const double now = steady_seconds();
    spent_ += now - std::exchange(begun_, now);
  }
  done_ += forecast;
  return std::atoi(Input::open(marker).read_text().c_str());
}

void CameraWork::run(const std::string& name, const char* title, double forecast,
                     const std::function<void(const std::function<void(double)>&)>& work) {
  run_once(name, title, forecast, [&](const std::function<void(double)>& report) {
    work(report);
    return 0;
  });
}

bool CameraWork::run(const ColmapStage& stage) {
  return run_once(stage.name, stage.title, stage.forecast, [&](const auto&) {
           const fs::path log = options_.folder / "logs" / (stage.name + ".txt");
           if (std::error_code error; !fs::exists(stage.input, error))
             throw OutputError({stage.input.string()}, "is missing; the work folder was changed",
                               "remove " + options_.folder.string() + " to start again");
           const int code = follow(stage, log);
           if (code != 0 && !(stage.may_fail && code == EXIT_FAILURE))
             throw Error({log.string()}, fmt::format("colmap {} failed with exit code {}: {}",
                                                     stage.arguments.front(), code, end_of(log)));
           return code;
         }) == 0;
}

int CameraWork::follow(const ColmapStage& stage, const fs::path& log) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> output(std::fopen(log.c_str(), "wb"),
                                                               &std::fclose);
  if (!output) throw OutputError({log.string()}, "cannot be opened");
  NewLines lines(log);
  double fraction = 0;
  const auto report = [&] {
    lines.each([&](std::string_view line) {
      if (const auto found = stage.progress(line)) fraction = *found;
    });
    progress(stage.title, stage.forecast, fraction);
  };
  std::optional<Process> process;
  try {
    // In a group of its own, it is ended by this program only, after a complete line of progress.
    process.emplace(options_.colmap, stage.arguments,
                    Process::Options{.input = Process::Input::none,
                                     .output = output.get(),
                                     .errors = output.get(),
                                     .own_group = true,
                                     .ends_with_us = true});
  } catch (const std::system_error& reason) {
    throw UsageError(options_.colmap + " cannot be started: " + reason.code().message());
  }
  while (!process->ended()) {
    report();  // may throw, which kills COLMAP; its database survives this
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  report();
  return process->wait();
}

void CameraWork::remove() {
  lock_.reset();
  std::error_code ignored;
  fs::remove_all(options_.folder, ignored);
}

}  // namespace tureen
