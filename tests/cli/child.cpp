#include "tests/cli/child.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>

namespace tureen::test {

namespace {

/// In the child: `target` becomes the file descriptor of this file.
void redirect(const char* path, int flags, int target) {
  const int file = ::open(path, flags, 0644);
  if (file < 0 || ::dup2(file, target) < 0) ::_exit(126);
  if (file != target) ::close(file);
}

}  // namespace

std::string bytes_of_file(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

Child::Child(const std::vector<std::string>& arguments, std::filesystem::path folder,
             const std::string& program)
    : folder_(std::move(folder)) {
  std::vector<std::string> words{program.empty() ? TUREEN_PROGRAM : program};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  pid_ = ::fork();
  if (pid_ < 0) throw std::runtime_error("cannot create a process");
  if (pid_ > 0) return;
  // From here on, only system calls are safe: the test may have other threads.
  if (::chdir(folder_.c_str()) != 0) ::_exit(126);
  ::signal(SIGINT, SIG_DFL);  // shells ignore it in background jobs
  redirect("/dev/null", O_RDONLY, STDIN_FILENO);
  redirect("stdout.txt", O_WRONLY | O_CREAT | O_TRUNC, STDOUT_FILENO);
  redirect("stderr.txt", O_WRONLY | O_CREAT | O_TRUNC, STDERR_FILENO);
  ::execv(argv.front(), argv.data());
  ::_exit(127);
}

Child::~Child() {
  if (!running()) return;
  signal(SIGKILL);
  wait();
}

void Child::signal(int number) const {
  if (pid_ > 0) ::kill(pid_, number);
}

void Child::stop() {
  signal(SIGSTOP);
  int status = 0;
  if (pid_ < 0 || ::waitpid(pid_, &status, WUNTRACED) != pid_ || WIFSTOPPED(status)) return;
  status_ = status;  // it ended before the signal arrived
  pid_ = -1;
}

bool Child::running() {
  if (pid_ > 0 && ::waitpid(pid_, &status_, WNOHANG) == pid_) pid_ = -1;
  return pid_ > 0;
}

bool Child::wait_until(const std::function<bool()>& condition) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(2);
  while (!condition()) {
    if (!running()) return condition();
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

bool Child::has_loaded(const std::string& library) const {
  const std::string maps = "/proc/" + std::to_string(pid_) + "/maps";
  return pid_ > 0 && bytes_of_file(maps).find(library) != std::string::npos;
}

ChildResult Child::wait() {
  while (pid_ > 0)
    if (::waitpid(pid_, &status_, 0) == pid_ || errno != EINTR) pid_ = -1;
  return {WIFEXITED(status_) ? WEXITSTATUS(status_) : -1, bytes_of_file(folder_ / "stdout.txt"),
          bytes_of_file(folder_ / "stderr.txt")};
}

ChildResult run_tureen(const std::vector<std::string>& arguments,
                       const std::filesystem::path& folder) {
  return Child(arguments, folder).wait();
}

}  // namespace tureen::test
