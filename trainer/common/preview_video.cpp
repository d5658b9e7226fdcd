#include "trainer/common/preview_video.hpp"

#include <algorithm>
#include <vector>

#include "base/input.hpp"
#include "image/png.hpp"
#include "image/video_file.hpp"

namespace tureen::trainer {

namespace {

namespace fs = std::filesystem;

constexpr double max_seconds = 10;
/// Some players do not support lower rates.
constexpr double min_frames_per_second = 5;

Image8 read_frame(const fs::path& file) {
  Input input = Input::open(file);
  return read_image(input);
}

}  // namespace

fs::path preview_video_file(const fs::path& previews) {
  fs::path file = previews;
  file.replace_extension();
  return file += "-previews.mp4";
}

std::optional<fs::path> write_preview_video(const fs::path& previews) {
  if (!have_ffmpeg()) return std::nullopt;
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(previews))
    if (entry.path().extension() == ".png" && entry.path().filename().string().starts_with("step_"))
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  if (files.size() < 2) return std::nullopt;
  const Image8 first = read_frame(files.front());
  const fs::path path = preview_video_file(previews);
  VideoFile video(path, {.width = first.width,
                         .height = first.height,
                         .frames_per_second =
                             std::max(min_frames_per_second, double(files.size()) / max_seconds)});
  for (const fs::path& file : files) {
    const Image8 frame = read_frame(file);
    // Images of an earlier run with another size.
    if (frame.width != first.width || frame.height != first.height) return std::nullopt;
    video.add(frame);
  }
  video.commit();
  return path;
}

}  // namespace tureen::trainer
