// Writes videos with ffmpeg, which is needed only for this. Frames go to its standard input
// uncompressed; no shell is involved. Not available in a browser, which cannot start programs.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "base/platform/process.hpp"
#include "image/image.hpp"

namespace tureen {

/// Whether the name ends in .mp4 or .webm, in any case.
bool is_video_name(const std::filesystem::path& path);

/// The reason and the hint of the error if ffmpeg is missing.
inline constexpr const char* ffmpeg_missing =
    "videos need ffmpeg, which is not installed (package ffmpeg in Debian and Ubuntu)";
inline constexpr const char* ffmpeg_hint = "-o frame_%04d.png writes the frames as images instead";

/// Whether a folder of PATH contains ffmpeg.
bool have_ffmpeg();

/// H.264 in .mp4, VP9 in .webm; 8 bits, BT.709, chroma at half the resolution, which all players
/// support. Odd sides repeat their last row or column. Alpha is dropped.
class VideoFile {
 public:
  struct Format {
    int width = 0;  // of every frame, 1..max_image_side
    int height = 0;
    double frames_per_second = 30;
  };

  /// Starts ffmpeg with a temporary name beside `path`. Throws UsageError if the extension is not
  /// that of a video or ffmpeg is missing. Throws OutputError if ffmpeg cannot be started.
  VideoFile(std::filesystem::path path, const Format& format);
  VideoFile(const VideoFile&) = delete;
  VideoFile& operator=(const VideoFile&) = delete;
  /// Ends ffmpeg and removes the temporary file unless commit() has succeeded.
  ~VideoFile();

  /// Sends a frame; blocks while ffmpeg is busy. Asserts the size. Throws OutputError with the
  /// error message from ffmpeg.
  void add(const Image8& frame);

  /// Waits for ffmpeg and renames the file to the path. Throws OutputError and leaves an existing
  /// file unchanged. Asserts at least one frame.
  void commit();

 private:
  void start();
  [[noreturn]] void fail();

  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::filesystem::path path_, target_, temporary_;  // target_: path_ with links resolved
  Format format_;
  std::unique_ptr<std::FILE, Close> complaints_;  // stderr of ffmpeg; unnamed file
  std::optional<Process> process_;                // ffmpeg, after start()
  std::vector<std::uint8_t> bytes_;               // one frame
};

}  // namespace tureen
