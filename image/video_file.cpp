#include "image/video_file.hpp"

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
#include <cstring>
#include <string_view>
#include <utility>

#include "base/error.hpp"
#include "base/extension.hpp"
#include "base/output_path.hpp"

extern char** environ;  // POSIX declares it in no header

namespace tureen {

namespace {

namespace fs = std::filesystem;

int even(int side) { return side + side % 2; }

std::string number(double value) {
  // %g prints a decimal point, since the program never sets a locale.
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%.9g", value);
  return text.data();
}

/// Encoder options with barely visible compression.
std::vector<std::string> coder(const std::string& extension) {
  if (extension == ".webm")
    return {"-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0", "-row-mt", "1", "-f", "webm"};
  // faststart puts the index first, so that a page plays the file while it loads.
  return {"-c:v",   "libx264",   "-crf",       "18", "-preset",
          "medium", "-movflags", "+faststart", "-f", "mp4"};
}

std::vector<std::string> arguments(const VideoFile::Format& format, const std::string& extension,
                                   const std::string& output) {
  std::vector<std::string> result{
      "ffmpeg", "-nostdin", "-hide_banner", "-loglevel", "error", "-y", "-f", "rawvideo",
      "-pixel_format", "rgb24", "-video_size",
      std::to_string(even(format.width)) + "x" + std::to_string(even(format.height)), "-framerate",
      number(format.frames_per_second), "-i", "pipe:0", "-an",
      // The frames are sRGB. Players assume BT.709, but ffmpeg would convert with BT.601.
      "-vf", "scale=out_color_matrix=bt709:out_range=tv,format=yuv420p", "-colorspace", "bt709",
      "-color_primaries", "bt709", "-color_trc", "iec61966-2-1", "-color_range", "tv"};
  for (std::string& word : coder(extension)) result.push_back(std::move(word));
  // Without "file:", ffmpeg would read a colon as a protocol and a dash as an option.
  result.push_back("file:" + output);
  return result;
}

/// Both ends of a connection that child processes do not inherit. It is a socket, because a write
/// to a socket can suppress SIGPIPE.
std::array<int, 2> connection() {
  std::array<int, 2> ends{-1, -1};
  if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()) != 0)
    throw OutputError({}, "cannot connect to ffmpeg");
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

}  // namespace

bool is_video_name(const fs::path& path) {
  const std::string extension = extension_of(path);
  return extension == ".mp4" || extension == ".webm";
}

bool have_ffmpeg() {
  const char* folders = std::getenv("PATH");
  std::string_view rest = folders ? folders : "";
  while (!rest.empty()) {
    const std::string_view folder = rest.substr(0, rest.find(':'));
    rest.remove_prefix(std::min(rest.size(), folder.size() + 1));
    if (!folder.empty() && access((fs::path(folder) / "ffmpeg").c_str(), X_OK) == 0) return true;
  }
  return false;
}

VideoFile::VideoFile(fs::path path, const Format& format)
    : path_(std::move(path)), format_(format) {
  assert(format.width > 0 && format.height > 0 && format.frames_per_second > 0);
  if (!is_video_name(path_))
    throw UsageError("'" + path_.string() + "' is not a video name; it must end in .mp4 or .webm");
  if (!have_ffmpeg()) throw UsageError(ffmpeg_missing, ffmpeg_hint);
  target_ = writable_file(path_);
  const fs::path folder = target_.parent_path();
  std::error_code error;
  if (!folder.empty() && !fs::is_directory(folder, error))
    throw OutputError({path_.string(), {}, {}}, "there is no folder " + folder.string());
  temporary_ = temporary_beside(target_);
  bytes_.resize(std::size_t(3) * even(format.width) * even(format.height));
  start();
}

void VideoFile::start() {
  complaints_.reset(std::tmpfile());
  if (!complaints_) throw OutputError({}, "cannot create a temporary file for ffmpeg");
  const std::array<int, 2> ends = connection();
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDIN_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, fileno(complaints_.get()), STDERR_FILENO);
  // In a separate process group, ffmpeg does not receive Ctrl-C, on which it would write a
  // truncated video.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);
  std::vector<std::string> words = arguments(format_, extension_of(path_), temporary_.string());
  std::vector<char*> vector;
  for (std::string& word : words) vector.push_back(word.data());
  vector.push_back(nullptr);
  pid_t child = -1;
  const int error = posix_spawnp(&child, "ffmpeg", &actions, &attributes, vector.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  if (error != 0) {
    close(ends[0]);
    throw OutputError({}, std::string("ffmpeg cannot be started: ") + std::strerror(error));
  }
  input_ = ends[0];
  process_ = child;
}

VideoFile::~VideoFile() {
  if (process_ >= 0) {
    kill(process_, SIGKILL);
    wait();
  }
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove(temporary_, ignored);
}

/// The exit status of ffmpeg; 127 if a signal ended it.
int VideoFile::wait() {
  if (input_ >= 0) close(std::exchange(input_, -1));
  int status = 0;
  while (waitpid(process_, &status, 0) < 0)
    if (errno != EINTR) break;
  process_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 127;
}

void VideoFile::fail() {
  if (process_ >= 0) wait();
  std::string text(500, '\0');
  std::rewind(complaints_.get());
  text.resize(std::fread(text.data(), 1, text.size(), complaints_.get()));
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  throw OutputError({path_.string(), {}, {}},
                    "ffmpeg failed" + (text.empty() ? std::string() : ": " + text));
}

void VideoFile::send(const std::vector<std::uint8_t>& bytes) {
  for (std::size_t sent = 0; sent < bytes.size();) {
    const ssize_t count = ::send(input_, bytes.data() + sent, bytes.size() - sent, without_signal);
    if (count >= 0) {
      sent += std::size_t(count);
    } else if (errno != EINTR) {
      fail();  // ffmpeg has ended; its stderr has the reason
    }
  }
}

void VideoFile::add(const Image8& frame) {
  assert(process_ >= 0 && frame.width == format_.width && frame.height == format_.height);
  const int width = even(frame.width), height = even(frame.height);
  std::uint8_t* byte = bytes_.data();
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const glm::u8vec4& pixel =
          frame.at(std::min(x, frame.width - 1), std::min(y, frame.height - 1));
      *byte++ = pixel.r;
      *byte++ = pixel.g;
      *byte++ = pixel.b;
    }
  send(bytes_);
}

void VideoFile::commit() {
  assert(process_ >= 0);
  if (wait() != 0) fail();
  std::error_code error;
  fs::rename(temporary_, target_, error);
  if (error) throw OutputError({path_.string(), {}, {}}, "cannot be replaced: " + error.message());
  temporary_.clear();
}

}  // namespace tureen
