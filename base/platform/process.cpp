#include "base/platform/process.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

extern char** environ;  // POSIX declares it in no header

namespace tureen {

namespace {

/// Null-terminated. The strings must outlive the result; no function here changes them.
std::vector<char*> argv_of(const std::string& program, const std::vector<std::string>& arguments) {
  std::vector<char*> argv{const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  return argv;
}

[[noreturn]] void fail(int reason, const std::string& program) {
  throw std::system_error(reason, std::generic_category(), program);
}

/// A folder is not, although it has the same permission.
bool is_executable(const std::filesystem::path& path) {
  std::error_code ignored;
  return access(path.c_str(), X_OK) == 0 && std::filesystem::is_regular_file(path, ignored);
}

/// Both ends of a connection that child processes do not inherit, or -1 with errno. It is a socket,
/// because a write to a socket can suppress SIGPIPE.
std::array<int, 2> connection() {
  std::array<int, 2> ends{-1, -1};
  if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()) != 0) return ends;
  for (const int end : ends) fcntl(end, F_SETFD, FD_CLOEXEC);
#ifdef SO_NOSIGPIPE
  const int on = 1;
  setsockopt(ends[0], SOL_SOCKET, SO_NOSIGPIPE, &on, sizeof on);
#endif
  return ends;
}

#ifdef MSG_NOSIGNAL
constexpr int without_signal = MSG_NOSIGNAL;
#else
constexpr int without_signal = 0;
#endif

/// The actions and attributes of posix_spawn.
class Spawn {
 public:
  Spawn() {
    posix_spawn_file_actions_init(&actions_);
    posix_spawnattr_init(&attributes_);
  }
  Spawn(const Spawn&) = delete;
  Spawn& operator=(const Spawn&) = delete;
  ~Spawn() {
    posix_spawnattr_destroy(&attributes_);
    posix_spawn_file_actions_destroy(&actions_);
  }

  void discard(int descriptor, int mode) {
    posix_spawn_file_actions_addopen(&actions_, descriptor, "/dev/null", mode, 0);
  }
  void connect(int ours, int descriptor) {
    posix_spawn_file_actions_adddup2(&actions_, ours, descriptor);
  }
  void write_to(std::FILE* stream, int descriptor) {
    if (!stream)
      discard(descriptor, O_WRONLY);
    else if (fileno(stream) != descriptor)
      connect(fileno(stream), descriptor);
  }
  void make_group() {
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF);
    posix_spawnattr_setpgroup(&attributes_, 0);
    // A shell starts programs of the background with SIGINT ignored, and children inherit this.
    sigset_t ending;
    sigemptyset(&ending);
    for (const int signal : {SIGINT, SIGTERM}) sigaddset(&ending, signal);
    posix_spawnattr_setsigdefault(&attributes_, &ending);
  }

  /// Returns 0 or the reason why the program cannot be started.
  int start(pid_t& process, const std::string& program, const std::vector<std::string>& arguments) {
    return posix_spawnp(&process, program.c_str(), &actions_, &attributes_,
                        argv_of(program, arguments).data(), environ);
  }

 private:
  posix_spawn_file_actions_t actions_;
  posix_spawnattr_t attributes_;
};

}  // namespace

Process::Process(const std::string& program, const std::vector<std::string>& arguments,
                 const Options& options)
    : own_group_(options.own_group), ends_with_us_(options.ends_with_us) {
  Spawn spawn;
  std::array<int, 2> ends{-1, -1};
  if (options.input == Input::sent) {
    ends = connection();
    if (ends[0] < 0) fail(errno, program);
    spawn.connect(ends[1], STDIN_FILENO);
  } else if (options.input == Input::none) {
    spawn.discard(STDIN_FILENO, O_RDONLY);
  }
  std::array<int, 2> outputs{-1, -1};
  if (options.received) {
    outputs = connection();
    if (outputs[0] < 0) {
      const int reason = errno;
      for (const int end : ends)
        if (end >= 0) close(end);
      fail(reason, program);
    }
    spawn.connect(outputs[1], STDOUT_FILENO);
  } else {
    spawn.write_to(options.output, STDOUT_FILENO);
  }
  spawn.write_to(options.errors, STDERR_FILENO);
  if (own_group_) spawn.make_group();
  pid_t process = -1;
  int reason = 0;
  // posix_spawn cannot ask for the signal; setpriv asks, and becomes the program.
  // For a program that cannot be started it would end with a code of its own.
  if (options.ends_with_us && is_on_path("setpriv") &&
      (program.find('/') != std::string::npos ? is_executable(program) : is_on_path(program))) {
    std::vector<std::string> words{"--pdeathsig", "KILL", program};
    words.insert(words.end(), arguments.begin(), arguments.end());
    reason = spawn.start(process, "setpriv", words);
  } else {
    reason = spawn.start(process, program, arguments);
  }
  for (const int theirs : {ends[1], outputs[1]})
    if (theirs >= 0) close(theirs);
  input_ = ends[0];
  output_ = outputs[0];
  if (reason != 0) {
    close_input();
    if (output_ >= 0) close(output_);
    fail(reason, program);
  }
  process_ = process;
}

void Process::close_input() {
  if (input_ >= 0) close(std::exchange(input_, -1));
}

bool Process::send(std::span<const std::byte> bytes) {
  assert(input_ >= 0);
  while (!bytes.empty()) {
    const ssize_t count = ::send(input_, bytes.data(), bytes.size(), without_signal);
    if (count >= 0)
      bytes = bytes.subspan(std::size_t(count));
    else if (errno != EINTR)
      return false;
  }
  return true;
}

std::size_t Process::receive(std::span<std::byte> bytes) {
  assert(output_ >= 0);
  std::size_t filled = 0;
  while (filled < bytes.size()) {
    const ssize_t count = read(output_, bytes.data() + filled, bytes.size() - filled);
    if (count == 0 || (count < 0 && errno != EINTR)) break;
    if (count > 0) filled += std::size_t(count);
  }
  return filled;
}

bool Process::notice_end(bool waits) {
  if (exit_code_) return true;
  int status = 0;
  const pid_t found = waitpid(process_, &status, waits ? 0 : WNOHANG);
  if (found == process_)
    exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  else if (found < 0 && errno != EINTR)
    exit_code_ = 0;  // it has ended, and its exit code is lost: this program ignores SIGCHLD
  return exit_code_.has_value();
}

bool Process::send_signal(int signal) {
  // Not after its end, when another process may have its number.
  return !ended() && ::kill(own_group_ ? -process_ : process_, signal) == 0;
}

bool Process::interrupt() { return send_signal(SIGINT); }

void Process::end(std::chrono::milliseconds patience) {
  constexpr std::chrono::milliseconds poll{50};
  for (const int signal : {SIGINT, SIGTERM, SIGKILL}) {
    send_signal(signal);
    const auto until = std::chrono::steady_clock::now() + patience;
    while (!ended() && (signal == SIGKILL || std::chrono::steady_clock::now() < until))
      std::this_thread::sleep_for(poll);
  }
}

void Process::kill() {
  send_signal(SIGKILL);
  wait();
}

Process::~Process() {
  if (ends_with_us_) kill();
  close_input();
  if (output_ >= 0) close(output_);
}

bool Process::ended() { return notice_end(false); }

int Process::wait() {
  close_input();
  while (!notice_end(true)) {
  }
  return *exit_code_;
}

void become_program(const std::string& program, const std::vector<std::string>& arguments) {
  execvp(program.c_str(), argv_of(program, arguments).data());
  fail(errno, program);
}

std::string output_of(const std::string& program, const std::vector<std::string>& arguments) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::tmpfile(), &std::fclose);
  if (!file) return {};
  try {
    Process process(program, arguments,
                    {.input = Process::Input::none, .output = file.get(), .errors = nullptr});
    if (process.wait() != 0) return {};
  } catch (const std::system_error&) {
    return {};
  }
  std::string text;
  std::array<char, 4096> part;
  std::rewind(file.get());
  while (const std::size_t count = std::fread(part.data(), 1, part.size(), file.get()))
    text.append(part.data(), count);
  return text;
}

bool is_on_path(const std::string& program) {
  const char* folders = std::getenv("PATH");
  std::string_view rest = folders ? folders : "";
  while (!rest.empty()) {
    const std::string_view folder = rest.substr(0, rest.find(':'));
    rest.remove_prefix(std::min(rest.size(), folder.size() + 1));
    if (!folder.empty() && is_executable(std::filesystem::path(folder) / program)) return true;
  }
  return false;
}

std::string shell_word(const std::string& text) {
  constexpr std::string_view plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./,:+=@%";
  if (!text.empty() && text.find_first_not_of(plain) == std::string::npos) return text;
  std::string result = "'";
  for (const char letter : text) {
    if (letter == '\'')
      result += "'\\''";
    else
      result += letter;
  }
  return result + "'";
}

}  // namespace tureen
