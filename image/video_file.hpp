// Videos, by ffmpeg: a program that is asked for when a video is to be written and not before.
// Frames go to its standard input as they are; no shell reads a word. Not in a browser, which has
// no programs.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "image/image.hpp"

namespace tureen {

/// Whether the name ends in .mp4 or .webm, in any case.
bool is_video_name(const std::filesystem::path& path);

/// The reason and the hint for an error where there is no ffmpeg.
inline constexpr const char* ffmpeg_missing =
    "videos are written by ffmpeg, which is not installed (Debian and Ubuntu: ffmpeg)";
inline constexpr const char* ffmpeg_hint = "-o frame_%04d.png writes frames as pictures without it";

/// Whether ffmpeg lies in one of the folders of PATH.
bool have_ffmpeg();

/// H.264 in .mp4, VP9 in .webm, 8 bits, BT.709, colours at half the resolution as all players take
/// them. Sides of odd length get their last row or column twice. Alpha is left out.
class VideoFile {
 public:
  struct Format {
    int width = 0;  // of every frame, 1..max_image_side
    int height = 0;
    double frames_per_second = 30;
  };

  /// Starts ffmpeg with a temporary name beside `path`. Throws UsageError where the name is none of
  /// a video's or ffmpeg is missing, OutputError where it cannot be started.
  VideoFile(std::filesystem::path path, const Format& format);
  VideoFile(const VideoFile&) = delete;
  VideoFile& operator=(const VideoFile&) = delete;
  /// Ends ffmpeg and removes the temporary file unless commit() was reached.
  ~VideoFile();

  /// Waits while ffmpeg is busy with those before. Asserts the size. Throws OutputError with what
  /// ffmpeg complains about.
  void add(const Image8& frame);

  /// Lets ffmpeg finish and renames over the path. Throws OutputError; what was there is then
  /// untouched. Asserts a frame.
  void commit();

 private:
  void start();
  void send(const std::vector<std::uint8_t>& bytes);
  int wait();
  [[noreturn]] void fail();

  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::filesystem::path path_, target_, temporary_;  // the second with links followed
  Format format_;
  std::unique_ptr<std::FILE, Close> complaints_;  // without a name
  int input_ = -1;                                // our end of its standard input
  int process_ = -1;
  std::vector<std::uint8_t> bytes_;  // of one frame
};

}  // namespace tureen
