#include "image/video_file.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cctype>
#include <span>
#include <system_error>
#include <utility>

#include "base/error.hpp"
#include "base/extension.hpp"
#include "base/output_path.hpp"

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
      "-nostdin", "-hide_banner", "-loglevel", "error", "-y", "-f", "rawvideo", "-pixel_format",
      "rgb24", "-video_size",
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

}  // namespace

bool is_video_name(const fs::path& path) {
  const std::string extension = extension_of(path);
  return extension == ".mp4" || extension == ".webm";
}

bool have_ffmpeg() { return is_on_path("ffmpeg"); }

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
    throw OutputError({path_.string()}, "there is no folder " + folder.string());
  temporary_ = temporary_beside(target_);
  bytes_.resize(std::size_t(3) * even(format.width) * even(format.height));
  start();
}

void VideoFile::start() {
  complaints_.reset(std::tmpfile());
  if (!complaints_) throw OutputError({}, "cannot create a temporary file for ffmpeg");
  // In a group of its own, ffmpeg does not receive Ctrl-C, on which it would write a truncated
  // video.
  try {
    process_.emplace("ffmpeg", arguments(format_, extension_of(path_), temporary_.string()),
                     Process::Options{.input = Process::Input::sent,
                                      .output = nullptr,
                                      .errors = complaints_.get(),
                                      .own_group = true});
  } catch (const std::system_error& reason) {
    throw OutputError({}, "ffmpeg cannot be started: " + reason.code().message());
  }
}

VideoFile::~VideoFile() {
  if (process_) process_->kill();
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove(temporary_, ignored);
}

void VideoFile::fail() {
  process_->wait();
  std::string text(500, '\0');
  std::rewind(complaints_.get());
  text.resize(std::fread(text.data(), 1, text.size(), complaints_.get()));
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  throw OutputError({path_.string()},
                    "ffmpeg failed" + (text.empty() ? std::string() : ": " + text));
}

void VideoFile::add(const Image8& frame) {
  assert(frame.width == format_.width && frame.height == format_.height);
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
  if (!process_->send(std::as_bytes(std::span(bytes_)))) fail();  // it has ended
}

void VideoFile::commit() {
  if (process_->wait() != 0) fail();
  std::error_code error;
  fs::rename(temporary_, target_, error);
  if (error) throw OutputError({path_.string()}, "cannot be replaced: " + error.message());
  temporary_.clear();
}

}  // namespace tureen
